// The step order of a coupling window, as one table.
//
// Each role follows its own column; together the columns give the order of the window:
//
//     schedule      solid                       fluid
//     fluid_first   receive, advance, send      advance, send, receive
//     solid_first   advance, send, receive      receive, advance, send
//     parallel      advance, send, receive      advance, send, receive
//
// What is received counts from the next advance on. So with fluid_first the fluid advances window k
// in the motion of the end of window k-1, and the solid under the load of window k; with
// solid_first the solid advances under the load of window k-1 (none before window 0), and the fluid
// in the motion of window k. The motion at the start goes to the fluid before window 0.

#pragma once

#include "duet/v1/coupling.pb.h"

#include <array>
#include <cstdint>
#include <optional>

namespace duet::protocol {

enum class Act { receive, advance, send };

/// What `role` does in each window, in order. Throws Error(SCENE) for a schedule this library does
/// not know.
const std::array<Act, 3>& acts(v1::Coupling::Schedule schedule, v1::Role role);

/// Whether the fluid knows the interface at the window's end when it advances (else it guesses).
bool end_is_known(v1::Coupling::Schedule schedule);

/// One side's place in the table: which act of which window is due. Knows no socket.
class Turn {
  public:
    /// Without a peer only the advances are left of the table.
    Turn(v1::Coupling::Schedule schedule, v1::Role role, bool peer);

    /// The act that is due; none between windows.
    std::optional<Act> due() const;

    /// Starts a window; it must be the next one. Throws Error(PEER) if it is not, and
    /// Error(INTERNAL) in the middle of a window.
    void begin(std::uint64_t window);

    /// The act that was due is done.
    void done();

    /// Of the next begin(); the run starts with 0.
    std::uint64_t next_window() const { return next_window_; }

    /// Goes on after `next_window - 1`, between windows only.
    void resume(std::uint64_t next_window);

  private:
    std::array<Act, 3> acts_{};
    std::size_t count_ = 0;
    std::size_t position_ = 0; // == count_ between windows
    std::uint64_t next_window_ = 0;
};

} // namespace duet::protocol
