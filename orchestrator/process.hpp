// A solver's process: started, watched, ended, and never left behind.

#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace duet::orchestrator {

/// How a process ended, and what it cost.
struct Ending {
    bool good = false;             ///< exited with status 0
    std::string text;              ///< "exited with status 3", "was ended by signal 9 (Killed)"
    double cpu = 0;                ///< s, all threads
    std::uint64_t peak_memory = 0; ///< bytes
};

class Process {
  public:
    using Clock = std::chrono::steady_clock;

    /// Starts `command` (program and arguments) with `environment` added to ours. Its standard
    /// output and error go, line by line, to `say`. The process leads a group of its own, so that a
    /// Ctrl-C in the terminal does not reach it, and dies with us even if we are killed. Throws
    /// std::runtime_error naming the program and the reason.
    Process(const std::vector<std::string>& command,
            const std::map<std::string, std::string>& environment,
            std::function<void(const std::string&)> say);

    /// Kills what still runs.
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    pid_t id() const { return id_; }
    /// Readable once the process has ended.
    int pidfd() const { return pidfd_; }
    /// Readable when it has printed something; -1 once it will print no more.
    int output() const { return output_; }
    /// Hands on what it has printed; never blocks.
    void read_output();

    /// How it ended, if it has.
    const std::optional<Ending>& poll();
    /// Waits until `deadline` for its end.
    const std::optional<Ending>& wait_until(Clock::time_point deadline);
    /// Ends the process and all it has started, at once.
    void kill();

    /// "running", "stopped", ...: what the system says of it now.
    std::string state() const;

  private:
    std::function<void(const std::string&)> say_;
    std::string line_; // printed, but not to its end yet
    pid_t id_ = -1;
    int pidfd_ = -1;
    int output_ = -1;
    std::optional<Ending> ending_;
};

/// The command of a solver: `given` split at blanks unless it names a file whole. A program without
/// a slash is looked for beside this program first, then in PATH. Throws std::runtime_error if
/// there is no such program; `option` is the remedy's name.
std::vector<std::string> find_command(const std::string& given, const std::string& option);

/// The folder of this program.
std::filesystem::path program_folder();

} // namespace duet::orchestrator
