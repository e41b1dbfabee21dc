#include "orchestrator/summary.hpp"

#include "orchestrator/figures.hpp"
#include "orchestrator/revision.hpp"
#include "protocol/version.hpp"

#include <nlohmann/json.hpp>

#include <sys/utsname.h>

#include <fstream>
#include <thread>

namespace duet::orchestrator {

namespace {

using Json = nlohmann::ordered_json;

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0)
            return line.substr(line.find(':') + 2);
    return "unknown";
}

Json machine_json() {
    utsname system{};
    ::uname(&system);
    return {{"host", system.nodename},
            {"system", std::string(system.sysname) + " " + system.release},
            {"processor", processor()},
            {"cores", std::thread::hardware_concurrency()}};
}

Json ledger_json(const v1::Ledger& ledger) {
    Json json;
    for (const auto& [name, value] : ledger_figures(ledger))
        json[name] = value;
    return json;
}

Json player_json(const Player& player) {
    Json phases = Json::object();
    for (const auto& [name, seconds] : player.timing.phase())
        phases[name] = seconds;
    return {{"solver", player.solver},
            {"threads", player.threads},
            {"models",
             std::vector<std::string>(player.model.model().begin(), player.model.model().end())},
            {"unknowns", player.model.unknowns()},
            {"interface_nodes", player.model.nodes()},
            {"steps", player.steps},
            {"windows", player.windows},
            {"ended", player.ending ? player.ending->text : "started by hand"},
            {"cpu_seconds", cpu_seconds(player)},
            {"peak_memory_bytes", peak_memory(player)},
            {"wall_seconds", player.timing.wall()},
            {"waiting_for_peer_seconds", player.timing.waiting_for_peer()},
            {"waiting_for_lease_seconds", player.timing.waiting_for_lease()},
            {"waiting_share", waiting_share(player)},
            {"cpu_seconds_by_phase", phases},
            {"ledger", ledger_json(player.ledger)}};
}

std::string ended_text(Ended ended) {
    switch (ended) {
    case Ended::finished:
        return "finished";
    case Ended::interrupted:
        return "interrupted";
    case Ended::failed:
        break;
    }
    return "failed";
}

} // namespace

std::string revision() {
    return DUET_REVISION;
}

Json balances_json(const Balances& balances) {
    return {{"heat", balances.heat},
            {"impulse", balances.impulse},
            {"work", balances.work},
            {"work_difference", balances.work_difference},
            {"total_heat_drift", balances.total_heat_drift},
            {"mass_drift", balances.mass_drift}};
}

std::string summary_json(const Case& given, const RunResult& result) {
    const v1::Version protocol_version = protocol::version();
    Json json = {
        {"case", given.name},
        {"title", given.scene.title()},
        {"version", DUET_VERSION},
        {"revision", revision()},
        {"protocol",
         std::to_string(protocol_version.major()) + "." + std::to_string(protocol_version.minor())},
        {"machine", machine_json()},
        {"ended", ended_text(result.ended)},
        {"failure", result.failure},
        {"time", result.time},
        {"windows", result.windows},
        {"wall_seconds", result.wall_seconds},
        {"balances", balances_json(result.balances)}};
    if (given.scene.has_fluid())
        json["seed"] = given.scene.fluid().seed();
    for (const Player& player : result.players)
        json["processes"][protocol::name_of(player.role)] = player_json(player);
    return json.dump(2) + "\n";
}

} // namespace duet::orchestrator
