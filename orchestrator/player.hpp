// What the conductor knows of one solver of a run.

#pragma once

#include "duet/v1/coupling.pb.h"
#include "orchestrator/failure.hpp"
#include "orchestrator/process.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace duet::orchestrator {

struct Player {
    v1::Role role = v1::ROLE_UNSPECIFIED;
    std::unique_ptr<Process> process; ///< none if the user starts it by hand
    std::uint32_t threads = 1;

    std::string solver; ///< name and version, from Hello
    bool ready = false;
    v1::Ready model;                ///< what it said when it was ready
    std::deque<v1::Report> reports; ///< of windows that the other has not reported yet
    v1::Ledger ledger;              ///< the newest
    v1::Timing timing;              ///< the newest
    std::uint64_t steps = 0;
    std::uint64_t windows = 0; ///< reported
    double time = 0;           ///< s, at the end of the last one
    std::string phase;         ///< what it did at its last heartbeat
    std::string last_words;    ///< the last line it printed
    bool failed = false;       ///< it has said Failed
    bool gone = false;         ///< it closed its connection, or sent Bye
    bool bye = false;
    std::optional<Ending> ending; ///< of its process

    /// The window it is in, or none before the first lease.
    When now() const { return {ready ? std::optional(windows) : std::nullopt, time}; }
};

/// "the fluid"
std::string name_of(const Player& player);

} // namespace duet::orchestrator
