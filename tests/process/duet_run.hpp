// A `duet` process under test: started with arguments, watched, and searched for what it leaves.

#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace duet::test {

/// A folder of its own for one test, removed at the end.
class Folder {
  public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

std::string read(const std::filesystem::path& file);

/// Waits until `condition` holds; false if it does not within `seconds`.
bool eventually(double seconds, const auto& condition);
void pause_briefly();

class DuetRun {
  public:
    using Clock = std::chrono::system_clock;

    /// Starts build/bin/duet with these arguments, its words collected in a file of `folder`.
    DuetRun(const Folder& folder, const std::vector<std::string>& arguments);
    ~DuetRun();
    DuetRun(const DuetRun&) = delete;
    DuetRun& operator=(const DuetRun&) = delete;

    /// Exit status (128 + n for signal n); none if it has not ended within `seconds`.
    std::optional<int> wait(double seconds);
    void signal(int number) const;

    /// What it has printed so far, both streams.
    std::string output() const { return read(output_); }

    /// Processes that it or its children have started and that still run.
    std::vector<pid_t> left_running() const;

    /// Wall time, since the epoch, at which wait() saw it end.
    double ended_at() const { return ended_at_; }

    /// The file in which a misbehaving participant notes when it misbehaved.
    std::filesystem::path stamp() const { return stamp_; }

  private:
    std::string mark_; // in the environment of every descendant
    std::filesystem::path output_;
    std::filesystem::path stamp_;
    pid_t id_ = -1;
    std::optional<int> status_;
    double ended_at_ = 0;
};

bool eventually(double seconds, const auto& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline)
            return false;
        pause_briefly();
    }
    return true;
}

} // namespace duet::test
