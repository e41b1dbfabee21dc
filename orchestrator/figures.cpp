#include "orchestrator/figures.hpp"

namespace duet::orchestrator {

const std::vector<Figure>& audit_figures() {
    static const std::vector<Figure> figures = {
        {"heat_balance", "largest |heat received by solid + by fluid| / heat exchanged"},
        {"impulse_balance", "largest |impulse received by solid + by fluid| / impulse exchanged"},
        {"work_balance", "|work on the solid + on the fluid| / the larger of the two"},
        {"total_heat_drift", "largest |change of all heat - all heat let in| / heat exchanged"},
        {"mass_drift", "largest relative change of a solver's mass"},
        {"waiting_share_fluid", "share of its wall time that the fluid waits for others"},
        {"waiting_share_solid", "share of its wall time that the solid waits for others"},
        {"cpu_seconds_fluid", "CPU time of the fluid process, s"},
        {"cpu_seconds_solid", "CPU time of the solid process, s"},
        {"peak_memory_fluid", "peak memory of the fluid process, bytes"},
        {"peak_memory_solid", "peak memory of the solid process, bytes"},
        {"wall_seconds", "wall time of the run, s"},
        {"windows", "number of coupling windows"},
        {"steps_fluid", "number of the fluid's steps"},
        {"steps_solid", "number of the solid's steps"},
    };
    return figures;
}

std::vector<std::string> audit_figure_names() {
    std::vector<std::string> names;
    for (const Figure& figure : audit_figures())
        names.push_back(figure.name);
    return names;
}

} // namespace duet::orchestrator
