// Leads the solvers through a run: handshake, leases ahead of the slower one, the books of every
// window, the end. Watches that nobody falls silent; every wait is bounded.

#pragma once

#include "orchestrator/audit.hpp"
#include "orchestrator/calendar.hpp"
#include "orchestrator/failure.hpp"
#include "orchestrator/player.hpp"
#include "orchestrator/progress.hpp"
#include "orchestrator/recorder.hpp"
#include "protocol/session.hpp"

#include <spdlog/logger.h>

#include <chrono>
#include <deque>
#include <vector>

namespace duet::orchestrator {

/// What a conductor needs to know of a run besides its solvers.
struct Score {
    v1::Configure configure;     ///< the same for all; role, threads, and peer_bind are filled in
    double connect_timeout = 10; ///< s, for a solver to say Hello
    double silence = 3;          ///< s without a heartbeat until a solver counts as stuck
    int signals = -1; ///< signalfd: the first asks for the end, the second for it at once
};

class Conductor {
  public:
    using Clock = std::chrono::steady_clock;

    Conductor(Score score,
              protocol::Session& session,
              std::vector<Player>& players,
              Recorder& recorder,
              Audit& audit,
              Progress& progress,
              spdlog::logger& log);

    /// Plays the run to its end, or to the end of the window at which a signal asked to stop:
    /// returns whether it was played to its end. Throws Failure, and Interrupted.
    bool play();

    /// Tells everybody to stop, and ends who does not within a second.
    void abort(const std::string& why);

    std::uint64_t windows() const { return closed_; }
    double time() const { return time_; }

  private:
    void gather();
    void lend_time();
    void close_windows();
    void close_window();
    void dismiss();

    void attend_next();
    void attend(protocol::Event event);
    void attend_message(Player& player, const v1::ToOrchestrator& message);
    void attend_descriptor(int descriptor);
    void attend_signal();
    void greet(Player& player, const v1::Hello& hello);
    void process_ended(Player& player);
    void read_last_words(const Player& player);
    void check_silence();
    Failure root_cause(const Failure& first);

    Player* player_of(v1::Role role);
    bool all(bool (*condition)(const Player&)) const;
    bool played_out() const;

    Score score_;
    protocol::Session& session_;
    std::vector<Player>& players_;
    Recorder& recorder_;
    Audit& audit_;
    Progress& progress_;
    spdlog::logger& log_;
    Calendar calendar_;

    std::deque<std::uint64_t> lease_ends_; // one past the last window of each lease that is out
    double stable_step_ = 0;               // s, for the next lease; 0: no limit
    std::uint64_t closed_ = 0;             // windows that all have reported
    double time_ = 0;                      // s, at the end of the last closed one
    bool gathering_ = true;
    bool stopping_ = false;
    Clock::time_point stop_deadline_;
};

} // namespace duet::orchestrator
