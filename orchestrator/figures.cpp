#include "orchestrator/figures.hpp"

#include "orchestrator/run.hpp"
#include "protocol/version.hpp"

#include <algorithm>
#include <cmath>

namespace duet::orchestrator {

std::map<std::string, double> ledger_figures(const v1::Ledger& ledger) {
    std::map<std::string, double> figures(ledger.figure().begin(), ledger.figure().end());
    const auto& descriptor = *v1::Ledger::descriptor();
    for (int i = 0; i < descriptor.field_count(); ++i)
        if (descriptor.field(i)->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE)
            figures[descriptor.field(i)->name()] =
                ledger.GetReflection()->GetDouble(ledger, descriptor.field(i));
    return figures;
}

namespace {

/// What both sides' kinetic and strain energy gained beyond the work and the losses that they
/// booked, relative to the largest of those: what the two schemes and the frozen window make.
/// Fluid and solid book the work at the interface each as they saw it.
void add_energy_residual(std::map<std::string, double>& figures) {
    if (!figures.count("fluid.mechanical_residual") || !figures.count("solid.energy_residual"))
        return;
    const double residual = figures["fluid.mechanical_residual"] + figures["solid.energy_residual"]
                            + figures["fluid.work"] + figures["solid.work"];
    double turnover = 0;
    for (const char* name : {"fluid.body_force_work",
                             "fluid.work_from_walls",
                             "fluid.viscous_loss",
                             "fluid.work",
                             "solid.work_of_own_loads",
                             "solid.work_of_supports",
                             "solid.work_of_expansion",
                             "solid.dissipated",
                             "solid.strain_energy",
                             "solid.kinetic_energy"})
        turnover = std::max(turnover, std::abs(figures[name]));
    if (turnover > 0)
        figures["mechanical_energy_residual"] = residual / turnover;
}

} // namespace

std::map<std::string, double> figures_of(const RunResult& result) {
    std::map<std::string, double> figures = {
        {"heat_balance", result.balances.heat},
        {"impulse_balance", result.balances.impulse},
        {"work_balance", result.balances.work},
        {"work_difference", result.balances.work_difference},
        {"total_heat_drift", result.balances.total_heat_drift},
        {"mass_drift", result.balances.mass_drift},
        {"wall_seconds", result.wall_seconds},
        {"windows", static_cast<double>(result.windows)},
    };
    for (const Player& player : result.players) {
        const std::string who = protocol::name_of(player.role);
        figures["waiting_share_" + who] = waiting_share(player);
        figures["cpu_seconds_" + who] = cpu_seconds(player);
        figures["peak_memory_" + who] = static_cast<double>(peak_memory(player));
        figures["steps_" + who] = static_cast<double>(player.steps);
        for (const auto& [name, value] : ledger_figures(player.ledger))
            figures[who + "." + name] = value;
    }
    add_energy_residual(figures);
    return figures;
}

} // namespace duet::orchestrator
