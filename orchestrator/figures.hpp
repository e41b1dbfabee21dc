// The audit figures of a run, as a check can name them.

#pragma once

#include "duet/v1/coupling.pb.h"

#include <map>
#include <string>
#include <vector>

namespace duet::orchestrator {

struct RunResult;

struct Figure {
    std::string name;
    std::string help;
};

/// The figures that the orchestrator works out itself: heat_balance, waiting_share_fluid, ...
/// Besides these, every number of a solver's ledger is a figure by the name "fluid.<number>" or
/// "solid.<number>".
const std::vector<Figure>& audit_figures();

/// Every number of a ledger by its name.
std::map<std::string, double> ledger_figures(const v1::Ledger& ledger);

/// All figures of a run by name.
std::map<std::string, double> figures_of(const RunResult& result);

} // namespace duet::orchestrator
