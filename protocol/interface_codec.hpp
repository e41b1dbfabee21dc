// What travels over the data plane: plain interface data to and from messages, with every check.
//
// Data of our own solver are checked before they leave (Error DIVERGED or INTERNAL), data of the
// peer when they arrive (Error PEER), in release builds too. No sockets here.

#pragma once

#include "protocol/solver.hpp"

#include <cstddef>
#include <span>

namespace duet::protocol {

/// Which exchange a message belongs to; the receiver knows it beforehand and takes no other.
struct Stamp {
    std::uint64_t run_id = 0;
    bool start = false; ///< the motion before window 0
    Window window;
};

/// Counts of the interface, fixed by the first message.
struct InterfaceSize {
    std::size_t nodes = 0;
    std::size_t segments = 0;
};

/// Chains and start of our own solid, as a message. Throws Error(INTERNAL) for chains that leave
/// out a node, name one twice or are too short, and Error(DIVERGED) for numbers that are not
/// finite.
InterfaceSize encode_start(const Stamp& stamp,
                           const std::vector<Chain>& chains,
                           const InterfaceMotion& start,
                           v1::ToPeer& message);

/// The first message of the solid; sets `chains` and `start`. Throws Error(PEER).
InterfaceSize decode_start(const v1::ToPeer& message,
                           const Stamp& expected,
                           std::vector<Chain>& chains,
                           InterfaceMotion& start);

/// The motion at the end of the stamp's window. Buffers of `message` and `motion` are reused.
void encode(const Stamp& stamp,
            const InterfaceSize& size,
            const InterfaceMotion& motion,
            v1::ToPeer& message);
void decode(const v1::ToPeer& message,
            const Stamp& expected,
            const InterfaceSize& size,
            InterfaceMotion& motion);

/// The load over the stamp's window.
void encode(const Stamp& stamp,
            const InterfaceSize& size,
            const InterfaceLoad& load,
            v1::ToPeer& message);
void decode(const v1::ToPeer& message,
            const Stamp& expected,
            const InterfaceSize& size,
            InterfaceLoad& load);

/// Throws Error(DIVERGED) naming the first figure of our own solver's report that is not finite.
void check_report(const v1::Report& report, const Window& window);

/// The first entry that is not finite; values.size() if there is none.
std::size_t first_not_finite(std::span<const double> values);

} // namespace duet::protocol
