#include "orchestrator/run.hpp"

#include "orchestrator/conductor.hpp"
#include "orchestrator/progress.hpp"
#include "orchestrator/run_folder.hpp"
#include "orchestrator/schema.hpp"
#include "orchestrator/summary.hpp"
#include "protocol/session.hpp"
#include "protocol/socket_folder.hpp"
#include "protocol/version.hpp"

#include <signal.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <random>
#include <thread>

namespace duet::orchestrator {

namespace {

constexpr double heartbeat_interval = 0.5; // s
constexpr double peer_timeout = 120;       // s; longer than the slowest window of a sane case

/// SIGINT, SIGTERM and SIGHUP come as readable bytes while this lives.
class Signals {
  public:
    Signals() {
        sigset_t set;
        sigemptyset(&set);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP})
            sigaddset(&set, signal);
        ::pthread_sigmask(SIG_BLOCK, &set, &before_);
        descriptor_ = ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
        if (descriptor_ < 0)
            throw std::runtime_error(std::string("cannot watch for signals: ")
                                     + std::strerror(errno));
    }
    ~Signals() {
        ::close(descriptor_);
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;
    int descriptor() const { return descriptor_; }

  private:
    sigset_t before_{};
    int descriptor_ = -1;
};

std::shared_ptr<spdlog::logger> open_log(const std::filesystem::path& file) {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_st>(file.string(), true);
    auto log = std::make_shared<spdlog::logger>("duet", sink);
    log->set_pattern("%Y-%m-%d %H:%M:%S.%e %l: %v");
    log->flush_on(spdlog::level::info);
    return log;
}

struct Part {
    v1::Role role;
    std::string program;
    std::string option;
    bool by_hand;
    std::vector<std::string> command;
};

/// The solvers that the scene needs, their programs found.
std::vector<Part> cast(const v1::Scene& scene, const RunOptions& options) {
    std::vector<Part> parts;
    if (scene.has_solid())
        parts.push_back({v1::ROLE_SOLID, options.solid, "--solid", options.solid_by_hand, {}});
    if (scene.has_fluid())
        parts.push_back({v1::ROLE_FLUID, options.fluid, "--fluid", options.fluid_by_hand, {}});
    for (Part& part : parts)
        part.command = find_command(part.program, part.option);
    return parts;
}

v1::Configure configure_for(const Case& given,
                            const RunFolder& folder,
                            const std::vector<Part>& parts,
                            const protocol::SocketFolder& sockets,
                            const protocol::Session& session) {
    const bool by_hand =
        std::any_of(parts.begin(), parts.end(), [](const Part& part) { return part.by_hand; });
    std::random_device random;
    v1::Configure configure;
    *configure.mutable_version() = protocol::version();
    configure.set_run_id(std::uint64_t{random()} << 32 | random());
    *configure.mutable_scene() = given.scene;
    configure.set_schedule(given.scene.coupling().schedule());
    configure.set_run_folder(folder.path().string());
    configure.set_case_folder(given.folder.string());
    configure.set_heartbeat_interval(heartbeat_interval);
    configure.set_timeout(by_hand ? 24 * 3600 : peer_timeout); // a debugger takes its time
    if (parts.size() == 2) {
        configure.set_peer_address(sockets.address("exchange"));
        configure.set_record(given.scene.output().coupling());
        if (configure.record())
            configure.set_record_address(session.record_address());
    }
    return configure;
}

/// Starts one solver, or tells the user how to.
void start(Player& player,
           const Part& part,
           const std::string& address,
           Progress& progress,
           spdlog::logger& log) {
    std::vector<std::string> command = part.command;
    command.insert(command.end(), {"--connect", address});
    // Threads that spin while the other solver works would take its cores; threads that sleep at
    // each barrier cost more than a short loop (an idle core is slow to wake). So they spin for
    // some 40 us, then sleep.
    const std::map<std::string, std::string> environment = {
        {"OMP_WAIT_POLICY", "passive"},
        {"GOMP_SPINCOUNT", "3000"},
        {"OMP_NUM_THREADS", std::to_string(player.threads)}};
    std::string line;
    for (const auto& [name, value] : environment)
        line += name + "=" + value + " ";
    for (const std::string& word : command)
        line += (&word == &command.front() ? "" : " ") + word;
    log.info("{}: {}", name_of(player), line);
    if (part.by_hand) {
        progress.say("waiting for you to start " + name_of(player) + ":\n  " + line);
        return;
    }
    const std::string who = protocol::name_of(part.role);
    player.process = std::make_unique<Process>(
        command, environment, [&player, &log, who](const std::string& text) {
            player.last_words = text;
            log.info("[{}] {}", who, text);
        });
}

/// Plays, and turns whatever goes wrong into the result's words.
void play(Conductor& conductor, RunResult& result, spdlog::logger& log) {
    try {
        result.ended = conductor.play() ? Ended::finished : Ended::interrupted;
        return;
    } catch (const Interrupted&) {
        result.ended = Ended::interrupted;
        conductor.abort("the user stopped the run");
        return;
    } catch (const Failure& failure) {
        result.failure = failure.what();
    } catch (const std::exception& error) { // a full disk, say
        result.failure =
            Failure("duet", {conductor.windows(), conductor.time()}, error.what()).what();
    }
    log.error("{}", result.failure);
    conductor.abort(result.failure);
}

} // namespace

int exit_status(const RunResult& result) {
    switch (result.ended) {
    case Ended::finished:
        return 0;
    case Ended::interrupted:
        return 130;
    case Ended::failed:
        break;
    }
    return 1;
}

RunResult run_case(const Case& given, const RunOptions& options) {
    const auto begun = std::chrono::steady_clock::now();
    const std::vector<Part> parts = cast(given.scene, options);
    const Signals signals;
    const RunFolder folder(options.output.empty() ? default_run_folder(given.name) : options.output,
                           options.overwrite);
    folder.write("case.toml", write_case(given.scene));
    const auto log = open_log(folder.file("log.txt"));
    log->info("duet plays {} in {}", given.file.string(), folder.path().string());

    RunResult result;
    result.folder = folder.path();
    Progress progress(given.scene.time().end());
    Recorder recorder(given.scene, folder);
    Audit audit(given.scene.coupling().schedule(), given.scene.coupling().balance_tolerance());
    const protocol::SocketFolder sockets;
    protocol::Session session(sockets.address("control"),
                              given.scene.output().coupling() ? sockets.address("record") : "");
    progress.say("duet plays " + given.name + " in " + folder.path().string());

    result.players.resize(parts.size());
    try {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            result.players[i].role = parts[i].role;
            result.players[i].threads = options.threads > 0 ? options.threads : default_threads();
            start(result.players[i], parts[i], session.address(), progress, *log);
        }
        Score score;
        score.configure = configure_for(given, folder, parts, sockets, session);
        score.connect_timeout = options.connect_timeout;
        score.signals = signals.descriptor();
        Conductor conductor(score, session, result.players, recorder, audit, progress, *log);
        play(conductor, result, *log);
        result.time = conductor.time();
        result.windows = conductor.windows();
    } catch (const std::exception& error) { // a program that the system cannot start
        result.failure = Failure("duet", {}, error.what()).what();
        log->error("{}", result.failure);
        for (Player& player : result.players)
            player.process.reset(); // ends it
    }
    result.balances = audit.balances();
    result.histories = recorder.histories();
    result.profiles = recorder.profiles();
    result.wall_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    folder.write("summary.json", summary_json(given, result));
    log->info("the run has ended after {} s", result.wall_seconds);
    return result;
}

std::uint32_t default_threads() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    ::sched_getaffinity(0, sizeof allowed, &allowed);
    return static_cast<std::uint32_t>(std::max(1, CPU_COUNT(&allowed)));
}

double cpu_seconds(const Player& player) {
    return player.ending ? player.ending->cpu : player.timing.cpu();
}

std::uint64_t peak_memory(const Player& player) {
    return player.ending ? player.ending->peak_memory : player.timing.peak_memory();
}

double waiting_share(const Player& player) {
    const double wall = player.timing.wall();
    return wall > 0 ? (player.timing.waiting_for_peer() + player.timing.waiting_for_lease()) / wall
                    : 0;
}

} // namespace duet::orchestrator
