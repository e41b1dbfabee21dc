// `duet check`: what a case will model, how large it is, and roughly what it will cost; all from
// the scene alone.

#pragma once

#include "orchestrator/case_file.hpp"

#include <string>

namespace duet::orchestrator {

std::string check_report(const Case& given, std::uint32_t threads);

} // namespace duet::orchestrator
