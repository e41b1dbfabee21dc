// summary.json: what a run was, how it ended, and what it cost.

#pragma once

#include "orchestrator/run.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace duet::orchestrator {

/// The revision of the sources that this program was built from; "unknown" outside a repository.
std::string revision();

/// { "heat": ..., "impulse": ..., ... }
nlohmann::ordered_json balances_json(const Balances& balances);

std::string summary_json(const Case& given, const RunResult& result);

} // namespace duet::orchestrator
