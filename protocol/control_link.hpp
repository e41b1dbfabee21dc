// The solver's end of the control plane: a thread of its own that owns the DEALER socket.
//
// So heartbeats go out and the loss of the orchestrator is seen while the solver computes. If the
// orchestrator is gone, or has sent Abort, and the solver does not come back to the library within
// a grace time, the thread ends the process: nothing is left running.

#pragma once

#include "duet/v1/coupling.pb.h"
#include "protocol/sockets.hpp"

#include <atomic>
#include <chrono>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace duet::protocol {

/// The orchestrator said Abort, or is gone: end, there is nobody to report to.
class Aborted : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What the next heartbeat says; written by the solver's thread.
struct Pulse {
    std::atomic<std::uint64_t> window{0};
    std::atomic<double> time{0};                   ///< s
    std::atomic<const char*> phase{"configuring"}; ///< a string literal
    std::atomic<double> interval{1};               ///< s between heartbeats
};

class ControlLink {
  public:
    using Clock = std::chrono::steady_clock;

    /// Starts connecting to `address`; throws Error(PEER) if it is no address.
    ControlLink(zmq::context_t& context, const std::string& address);

    /// Sends what was handed over (bounded by a second) and ends the thread.
    ~ControlLink();
    ControlLink(const ControlLink&) = delete;
    ControlLink& operator=(const ControlLink&) = delete;

    /// Hands over a message, to go out at once.
    void send(const v1::ToOrchestrator& message);

    /// Hands over a message that may wait a little for others: with windows shorter than
    /// post_patience, each wake-up of the thread would cost more than the exchange itself. It goes
    /// out with the next send() or flush(), with a later post(), or by flush_if_due().
    void post(const v1::ToOrchestrator& message);
    void flush();

    /// For a wait on other sockets: wake up at flush_due() and call flush_if_due().
    Clock::time_point flush_due() const;
    void flush_if_due();

    /// The next message in order; none when `deadline` passes. Throws as heed().
    std::optional<v1::ToSolver> receive(Clock::time_point deadline);

    /// For a wait on other sockets: poll the descriptor of this one too, and call heed() when it is
    /// readable. It keeps what came for receive(); throws Aborted on Abort and when the
    /// orchestrator is gone, Error(PEER) on bytes that are no message. A send may swallow the
    /// descriptor's signal: heed_after_send() before such a wait.
    zmq::socket_ref socket() { return near_; }
    void heed();
    void heed_after_send() {
        if (sent_)
            heed();
    }

    Pulse& pulse() { return pulse_; }

  private:
    static constexpr auto post_patience = std::chrono::milliseconds(5);

    void run();
    void forward_to_orchestrator();
    void forward_to_solver();
    void beat();
    void end(const std::string& reason);
    bool lost() const; // the orchestrator was there and is gone

    Pulse pulse_;
    std::deque<v1::ToSolver> inbox_;
    std::vector<zmq::message_t> posted_;
    Clock::time_point flushed_{};
    bool sent_ = false;  // since the last heed()
    zmq::socket_t near_; // inproc; the solver's thread uses this end, the link's thread the rest
    zmq::socket_t far_;
    zmq::socket_t dealer_;
    ConnectionMonitor monitor_;
    bool stopping_ = false; // the solver's thread wants no more
    bool ending_ = false;   // Abort came, or the orchestrator is gone
    Clock::time_point last_moment_{};
    std::string reason_;
    std::thread thread_;
};

} // namespace duet::protocol
