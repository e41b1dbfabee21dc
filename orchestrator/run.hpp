// One run from the case to the summary: folder, log, sockets, processes, conductor.

#pragma once

#include "orchestrator/audit.hpp"
#include "orchestrator/case_file.hpp"
#include "orchestrator/player.hpp"
#include "orchestrator/recorder.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace duet::orchestrator {

struct RunOptions {
    std::filesystem::path output; ///< run folder; empty: runs/<case>-<date>-<time>
    bool overwrite = false;
    std::uint32_t threads = 0; ///< of each solver; 0: as many as there are cores
    std::string solid = "duet-solid";
    std::string fluid = "duet-fluid";
    bool solid_by_hand = false; ///< print the command and wait for the user to start it
    bool fluid_by_hand = false;
    double connect_timeout = 10; ///< s
};

enum class Ended { finished, interrupted, failed };

/// All that is known of a run when it has ended.
struct RunResult {
    Ended ended = Ended::failed;
    std::string failure;          ///< the line: who, when, what
    std::filesystem::path folder; ///< absolute
    double wall_seconds = 0;
    double time = 0; ///< s, reached
    std::uint64_t windows = 0;
    Balances balances;
    std::vector<Player> players;
    std::map<std::string, History> histories;
    std::map<std::string, std::vector<Profile>> profiles;
};

/// Exit status of a command that ends with this run.
int exit_status(const RunResult& result);

/// Plays the case, showing progress on the terminal, and leaves the run folder complete, whatever
/// happens. Throws std::runtime_error only for what is wrong before there is one: a missing
/// program, a run folder in use.
RunResult run_case(const Case& given, const RunOptions& options);

/// Threads for each solver: all cores that this process may use. In serial schedules the two take
/// turns; if both advance at once, one of them is done long before the other in most scenes.
std::uint32_t default_threads();

/// CPU time and peak memory of a solver: as the system counted them for its process or, for one
/// started by hand, as it said itself.
double cpu_seconds(const Player& player);
std::uint64_t peak_memory(const Player& player);

/// Share of its wall time that a solver has waited, for its peer or for a lease.
double waiting_share(const Player& player);

} // namespace duet::orchestrator
