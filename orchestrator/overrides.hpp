// `--set solid.body[0].element_size=0.1`: one key of the case replaced on the command line.

#pragma once

#include <toml++/toml.h>

#include <string>

namespace duet::orchestrator {

/// Puts the value into the table, making tables on the way where there are none, and returns the
/// key's path. An index one past the end appends. Throws std::invalid_argument with a sentence.
std::string apply_override(toml::table& root, const std::string& text);

} // namespace duet::orchestrator
