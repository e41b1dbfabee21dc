#include "orchestrator/figures.hpp"

#include "orchestrator/run.hpp"
#include "protocol/version.hpp"

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
    return figures;
}

} // namespace duet::orchestrator
