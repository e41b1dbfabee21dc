// The fluid: weakly compressible SPH in either formulation (docs/theory-fluid.md), usable
// in-process. Knows neither files nor sockets.
//
//     Fluid fluid(config, chains, interface);          // throws SceneError
//     fluid.advance(window, start, end);               // throws Diverged
//     fluid.passed();                                  // impulse and heat of that window

#pragma once

#include "fluid_solver/scene.hpp"

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace duet::fluid {

/// The scene cannot be modelled: one sentence, with the place and the remedy.
class SceneError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The numbers left their bounds: one sentence, with the place and the remedy.
class Diverged : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

class Fluid {
  public:
    /// Fills the region minus the solids with particles. `interface` is the state of the interface
    /// nodes at t = 0; both it and `chains` are empty if there is no solid.
    explicit Fluid(const Config& config,
                   const std::vector<Chain>& chains = {},
                   const InterfaceState& interface = {});
    ~Fluid();
    Fluid(Fluid&&) noexcept;
    Fluid& operator=(Fluid&&) noexcept;

    /// Sets velocity, temperature and pressure of every particle at t = 0 from its position. To be
    /// called before the first window.
    void set_fields(const std::function<Values(Vec2)>& field);

    /// Advances by `window` seconds while the interface goes from `start` to `end`: temperatures
    /// linear in time, each node at constant acceleration, its way the integral of its velocity
    /// (docs/theory-fluid.md). Both empty without a solid. Returns the number
    /// of outer steps taken.
    int advance(double window, const InterfaceState& start, const InterfaceState& end);
    int advance(double window) { return advance(window, {}, {}); }

    /// What passed to the solid in the last window: exactly what the fluid booked as lost.
    const InterfaceImpulse& passed() const;

    double time() const;        ///< s
    double stable_step() const; ///< s, the outer step the present flow allows
    std::size_t size() const;   ///< number of particles
    std::size_t compartments() const;
    double particle_volume() const; ///< m2

    Ledger ledger() const;
    /// Means since the last mark start anew: a single window's force holds the sound of the cavity.
    void mark();
    const std::vector<WallReport>& walls() const; ///< in the order of Config::walls
    std::vector<Phase> phases() const;
    /// What is modelled, one line each, for the log.
    std::vector<std::string> model() const;

    /// The fields at a point of the fluid, exact for quadratic fields; with the known values of
    /// walls near the point. A point within a solid or outside gives NaN.
    Values at(Vec2 point) const;

    Snapshot snapshot() const;

    /// The whole state, as bytes; restored into a Fluid built from the same scene it goes on with
    /// the same bits, whatever the number of threads.
    std::string save() const;
    void restore(const std::string& state);

  private:
    class Implementation;
    std::unique_ptr<Implementation> self_;
};

} // namespace duet::fluid
