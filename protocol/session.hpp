// The orchestrator's side: one socket that serves both solvers.
//
//     Session session(folder.address("control"));
//     ... start the solvers with --connect session.address() ...
//     while (auto event = session.next(deadline)) {
//         switch (event->kind) { ... }
//     }
//
// Nothing here blocks beyond its deadline, and nothing a solver or a stranger sends can end the
// orchestrator. Not thread-safe: one thread uses a session.

#pragma once

#include "duet/v1/coupling.pb.h"
#include "protocol/version.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace duet::protocol {

/// What Session::next saw.
struct Event {
    enum class Kind {
        message,    ///< `message`, from `role`; it fits the state of that solver (coupling.proto)
        exchange,   ///< `exchange`: a copy of what `role` sent to its peer (Configure.record)
        descriptor, ///< the watched `descriptor` is readable
        refused,    ///< a message that does not fit: other version, second of a role, out of turn.
                    ///< `text` says so; the sender was told by Abort. A run cannot go on with it.
        garbage,    ///< bytes that are no message of the protocol; dropped. `text` for the log
        disconnected, ///< `role` closed its connection, or its process ended, before its Bye
    };
    Kind kind = Kind::message;
    v1::Role role = v1::ROLE_UNSPECIFIED; ///< unspecified: a connection that has not said Hello
    v1::ToOrchestrator message;
    v1::ToPeer exchange;
    int descriptor = -1;
    std::string text; ///< one sentence: who, what, and the remedy
};

class Session {
  public:
    using Clock = std::chrono::steady_clock;

    /// Binds `address` (ipc://path or tcp://host:port, port * for a free one), and `record_address`
    /// unless it is empty, for the copies of the exchanges. Throws std::runtime_error with the
    /// address and the reason.
    explicit Session(const std::string& address, const std::string& record_address = "");
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// The addresses as bound, with the port filled in: what a solver gets as --connect, and
    /// Configure.record_address.
    std::string address() const;
    std::string record_address() const;

    /// The next event, oldest first; none when `deadline` passes. A deadline in the past takes what
    /// is there. All that a solver sent comes before its disconnected event. A Hello is checked
    /// here (version, role); the answer, Configure, is the caller's, with version() in it.
    std::optional<Event> next(Clock::time_point deadline);

    /// Sends to the solver of that role. False, and nothing sent, if it is not connected (its
    /// disconnected event has come or will come).
    bool send(v1::Role role, const v1::ToSolver& message);

    /// Said Hello, and has neither failed nor ended nor gone.
    bool connected(v1::Role role) const;

    /// When the solver was last heard of, heartbeats included; Clock::time_point{} before its
    /// Hello.
    Clock::time_point last_heard(v1::Role role) const;

    /// next() also returns, with Kind::descriptor, when this descriptor is readable or at its end
    /// (pidfd, signalfd, pipe): every time, until it is unwatched or closed. The end of a process
    /// may be seen before its last messages; its disconnected event always comes after them.
    void watch(int descriptor);
    void unwatch(int descriptor);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace duet::protocol
