// What the terminal shows while a run is under way: a bar, or plain lines where there is none.

#pragma once

#include <chrono>
#include <string>

namespace duet::orchestrator {

class Progress {
  public:
    using Clock = std::chrono::steady_clock;

    /// `end` is the simulated time of the whole run, s.
    explicit Progress(double end);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// The run has reached `time`, s. Shows it when enough wall time has passed since the last
    /// show.
    void reached(double time);

    /// A line of its own, the bar out of the way.
    void say(const std::string& line);

  private:
    void draw(double time, Clock::time_point now);
    void clear();

    double end_;
    bool terminal_;
    bool drawn_ = false;
    Clock::time_point begun_ = Clock::now();
    Clock::time_point shown_ = begun_;
};

/// "75 s", "12 min 30 s", "3 h 20 min".
std::string duration_text(double seconds);

} // namespace duet::orchestrator
