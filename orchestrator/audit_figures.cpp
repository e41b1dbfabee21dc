#include "orchestrator/figures.hpp"

namespace duet::orchestrator {

const std::vector<Figure>& audit_figures() {
    static const std::vector<Figure> figures = {
        {"heat_balance", "largest sum of the heat both sides received, relative to all exchanged"},
        {"impulse_balance", "largest sum of the impulses on both sides, relative to all exchanged"},
        {"work_balance",
         "largest difference between the work the solid received and what the fluid's loads did in "
         "the motion it was told, relative to all exchanged"},
        {"work_difference",
         "sum of the works that each side saw, at the end, relative to the larger: what predicted "
         "motion and loads frozen in a window make"},
        {"total_heat_drift",
         "largest heat gained or lost beyond what was let in, relative to all exchanged"},
        {"mechanical_energy_residual",
         "kinetic and strain energy of both sides beyond the work and the losses that they booked, "
         "at the end, relative to the largest of these"},
        {"mass_drift", "largest relative change of a solver's mass"},
        {"waiting_share_fluid", "share of its wall time that the fluid waits for others"},
        {"waiting_share_solid", "share of its wall time that the solid waits for others"},
        {"cpu_seconds_fluid", "CPU time of the fluid process, s"},
        {"cpu_seconds_solid", "CPU time of the solid process, s"},
        {"peak_memory_fluid", "peak memory of the fluid process, bytes"},
        {"peak_memory_solid", "peak memory of the solid process, bytes"},
        {"steps_fluid", "number of the fluid's steps"},
        {"steps_solid", "number of the solid's steps"},
        {"wall_seconds", "wall time of the run, s"},
        {"windows", "number of coupling windows"},
    };
    return figures;
}

} // namespace duet::orchestrator
