// What the author of a solver implements, and the plain data it is given and gives.
//
// The library (participant.hpp) does the rest: sockets, handshake, turns, heartbeats, checks of
// everything received. A solver knows nothing of sockets; it may throw duet::protocol::Error from
// any function to end the run with a sentence.

#pragma once

#include "duet/v1/coupling.pb.h"

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace duet::protocol {

/// Ends the run: `code` and one sentence (what is wrong, and the remedy) reach the orchestrator.
class Error : public std::runtime_error {
  public:
    Error(v1::Failed::Code code, const std::string& sentence)
        : std::runtime_error(sentence), code_(code) {}
    v1::Failed::Code code() const { return code_; }

  private:
    v1::Failed::Code code_;
};

/// A chain of interface nodes; segment j runs from nodes[j] to nodes[j+1], the last one back to
/// nodes[0] if closed. The fluid lies to the right of the direction of travel.
struct Chain {
    std::vector<std::uint32_t> nodes;
    bool closed = false;
    bool insulated = false; ///< no heat passes: the heat flow there is zero
    std::string name = {};  ///< of the body, for messages; may be empty
    std::size_t segments() const { return closed ? nodes.size() : nodes.size() - 1; }
};

/// State of the interface at one time: N nodes.
struct InterfaceMotion {
    double time = 0;                 ///< s
    std::vector<double> position;    ///< [N][2] m
    std::vector<double> velocity;    ///< [N][2] m/s
    std::vector<double> temperature; ///< [N] K
    std::size_t nodes() const { return temperature.size(); }
};

/// Mean loads over one window: N nodes, M segments in the order of the chains.
struct InterfaceLoad {
    double time = 0;               ///< s, start of the window
    double length = 0;             ///< s
    std::vector<double> force;     ///< [N][2] N/m, on the solid
    std::vector<double> heat_flow; ///< [M] W/m, into the solid: flux times the segment's length
    double impulse_x = 0;          ///< N s/m, sum of force times length, as the fluid booked it
    double impulse_y = 0;
    double heat = 0;      ///< J/m, sum of heat_flow times length, as the fluid booked it
    double impedance = 0; ///< Pa s/m, by which the fluid answers a velocity of the wall at once,
                          ///< rho c; 0: not told
};

/// One coupling window.
struct Window {
    std::uint64_t index = 0;
    double time = 0;       ///< s, at its start
    double length = 0;     ///< s
    bool sample = false;   ///< fill Report::sample at its end
    bool snapshot = false; ///< write the fields at its end
};

/// Common to both sides. `Configure` holds the scene with all defaults filled in, the run's folder,
/// and the threads.
class Solver {
  public:
    virtual ~Solver() = default;

    /// Name and version, for the log.
    virtual std::string name() const = 0;

    /// The whole state at the end of the last window, as bytes of the solver's own; and back.
    /// Restoring and going on gives the same bits as never having stopped.
    virtual std::string save() const = 0;
    virtual void restore(const std::string& state) = 0;

    /// The run is over: flush and close the files.
    virtual void finish() = 0;
};

class SolidSolver : public Solver {
  public:
    /// Build the model; fill `ready` (stable step, size, model lines, ledger and samples at the
    /// start), the interface's chains and its state at the start. Both stay empty if there is no
    /// fluid in the scene.
    virtual void configure(const v1::Configure& configure,
                           v1::Ready& ready,
                           std::vector<Chain>& chains,
                           InterfaceMotion& start) = 0;

    /// Advance over one window under constant loads; give the interface's state at its end (all of
    /// it: `end` is an output) and fill `report` (steps, stable_step, ledger, samples if asked; not
    /// window, time, timing).
    virtual void advance(const Window& window,
                         const InterfaceLoad& load,
                         InterfaceMotion& end,
                         v1::Report& report) = 0;
};

class FluidSolver : public Solver {
  public:
    /// Build the model round the interface (empty if there is no solid) and fill `ready`.
    virtual void configure(const v1::Configure& configure,
                           const std::vector<Chain>& chains,
                           const InterfaceMotion& start,
                           v1::Ready& ready) = 0;

    /// Advance over one window while the interface moves from `start` (the state at the window's
    /// start) to `end`. With the solid first, `end` is the solid's state at the window's end; with
    /// the fluid first or both at once it is predicted by the library: acceleration and rate of the
    /// temperature go on as in the window before (zero in the first).
    virtual void advance(const Window& window,
                         const InterfaceMotion& start,
                         const InterfaceMotion& end,
                         InterfaceLoad& load,
                         v1::Report& report) = 0;
};

} // namespace duet::protocol
