// The audit figures that the orchestrator works out itself, as a check can name them.

#pragma once

#include <string>
#include <vector>

namespace duet::orchestrator {

struct Figure {
    std::string name;
    std::string help;
};

/// heat_balance, waiting_share_fluid, ... Besides these, every number of a solver's ledger is a
/// figure by the name "fluid.<number>" or "solid.<number>".
const std::vector<Figure>& audit_figures();

/// The names alone.
std::vector<std::string> audit_figure_names();

} // namespace duet::orchestrator
