// What the fluid core is told to model, and the plain data it exchanges: two dimensions, SI units,
// per metre of depth.

#pragma once

#include "fluid_solver/vector.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace duet::fluid {

/// A number, or a function of place (m) and time (s).
class Function {
  public:
    Function(double number = 0) : number_(number) {}
    /// `changes`: it depends on time too.
    Function(std::function<double(double x, double y, double t)> function, bool changes)
        : function_(std::move(function)), changes_(changes) {}

    double operator()(Vec2 place, double time) const {
        return function_ ? function_(place.x, place.y, time) : number_;
    }
    bool is_number() const { return !function_; }
    bool changes() const { return changes_; }

  private:
    double number_ = 0;
    std::function<double(double, double, double)> function_;
    bool changes_ = false;
};

struct VectorFunction {
    Function x, y;

    Vec2 operator()(Vec2 place, double time) const { return {x(place, time), y(place, time)}; }
    bool is_number() const { return x.is_number() && y.is_number(); }
    bool changes() const { return x.changes() || y.changes(); }
};

/// Turning about a point.
struct Rotation {
    Vec2 centre;   ///< m
    Function rate; ///< rad/s, counter-clockwise
};

/// What differs on a part of the cavity's boundary; all else is fixed, no-slip and adiabatic. A
/// wall that slips lies along an axis, so that each component of the velocity has one condition
/// there.
struct Wall {
    std::string name;
    Vec2 from = {}, to = {}; ///< every side on the line between them belongs to this wall
    std::optional<Function> temperature = {}; ///< K; without it the heat flux is known
    VectorFunction velocity = {};             ///< m/s; its part along the wall counts
    std::optional<Rotation> rotation = {};    ///< added to the velocity
    Function heat_flux = {};                  ///< W/m2, into the fluid
    std::optional<std::size_t> around =
        {};            ///< instead of from and to: 0 the region, k the k-th hole
    bool slip = false; ///< no shear: only across the wall is the velocity known
};

enum class PressureLevel {
    zero_mean, ///< the mean over each compartment is zero
    free       ///< compression itself is the physics
};

enum class Formulation {
    consistent, ///< exact for linear and quadratic fields (docs/theory-fluid.md)
    paper       ///< the source paper's sums, the baseline
};

/// The fluid's part of a scene.
struct Config {
    Formulation formulation = Formulation::consistent;
    double spacing = 0;                   ///< m, between neighbouring particles
    std::vector<Vec2> region;             ///< corners of the cavity, in order round it (either way)
    std::vector<std::vector<Vec2>> holes; ///< corners of what is cut out of it, likewise
    /// Directions in which the region, a rectangle, repeats itself: its two sides across them are
    /// no walls, and what leaves over one of them comes back over the other.
    Periodic periodic;
    double density = 1;               ///< kg/m3
    double kinematic_viscosity = 0;   ///< m2/s
    double heat_capacity = 1;         ///< J/(kg K)
    double conductivity = 0;          ///< W/(m K)
    double thermal_expansion = 0;     ///< 1/K
    double reference_temperature = 0; ///< K, where the buoyancy vanishes
    Function initial_temperature;     ///< K
    VectorFunction initial_velocity;  ///< m/s
    Vec2 gravity;                     ///< m/s2
    VectorFunction body_force;        ///< m/s2, beside the buoyancy
    std::vector<Wall> walls;
    PressureLevel pressure_level = PressureLevel::zero_mean;
    double sound_speed = 0; ///< m/s; 0 adapts it to the flow
    unsigned seed = 1;      ///< of the initial disorder
    double disorder = 0;    ///< initial random displacement, in spacings
    /// Laplacians away from walls, and those of T beside walls of one temperature, without the
    /// kernel's error; diffusion of second order in time.
    bool fourth_order = false;
    int threads = 1;
};

/// A chain of interface nodes: segment j runs from nodes[j] to nodes[j+1], the last one back to
/// nodes[0] if closed. The fluid lies to the right of the direction of travel. An open chain starts
/// and ends on the cavity's boundary and replaces what it covers of it.
struct Chain {
    std::vector<std::uint32_t> nodes;
    bool closed = false;
    bool insulated = false; ///< no heat passes
    std::string name = {};  ///< of the body, for messages
    std::size_t segments() const { return closed ? nodes.size() : nodes.size() - 1; }
};

/// The interface nodes at one time; three arrays of equal length.
struct InterfaceState {
    std::vector<Vec2> position;      ///< m
    std::vector<Vec2> velocity;      ///< m/s
    std::vector<double> temperature; ///< K
};

/// What passed to the solid in one window.
struct InterfaceImpulse {
    std::vector<Vec2> impulse; ///< N s/m, by node, on the solid
    std::vector<double> heat;  ///< J/m, by segment in the order of the chains, into the solid
};

/// The fields at one place.
struct Values {
    double temperature = 0;   ///< K
    Vec2 velocity;            ///< m/s
    double pressure = 0;      ///< Pa
    Vec2 temperature_slope{}; ///< K/m, only told
};

/// What the fluid holds and what has passed since the start.
struct Ledger {
    double mass = 0;                   ///< kg/m
    double heat = 0;                   ///< J/m, thermal energy relative to the start
    double heat_from_interface = 0;    ///< J/m
    double heat_from_walls = 0;        ///< J/m
    Vec2 impulse_from_interface;       ///< N s/m
    Vec2 impulse_from_walls;           ///< N s/m
    Vec2 impulse_from_body_force;      ///< N s/m, buoyancy included
    Vec2 momentum;                     ///< N s/m, relative to the start
    double work_from_interface = 0;    ///< J/m
    double work_from_walls = 0;        ///< J/m
    double body_force_work = 0;        ///< J/m, of buoyancy and the given body force
    double viscous_loss = 0;           ///< J/m, what the viscous term takes from the motion
    double kinetic_energy = 0;         ///< J/m
    double mechanical_residual = 0;    ///< J/m, kinetic energy gained beyond what the four explain
    Vec2 force_on_solids;              ///< N/m, mean since the last Fluid::mark
    double heat_flow_to_solids = 0;    ///< W/m, likewise
    double exchanged_heat = 0;         ///< J/m, absolute values summed over segments and windows
    double exchanged_impulse = 0;      ///< N s/m, absolute values summed over nodes and windows
    double mean_temperature = 0;       ///< K
    double max_speed = 0;              ///< m/s
    double sound_speed = 0;            ///< m/s
    double closure_conduction = 0;     ///< J/m, given back: Laplacian against wall flux, summed
    double closure_conduction_abs = 0; ///< J/m, absolute values summed over steps
    double closure_shift = 0;          ///< J/m, given back: correction after the shift, summed
    double closure_shift_abs = 0;      ///< J/m, absolute values summed over steps
    double closure_momentum_abs = 0;   ///< N s/m, without walls: given back, summed over steps
    std::uint64_t particles_outside = 0; ///< outside the cavity or inside a solid, now
    std::uint64_t wall_hits = 0;         ///< particles that were held off a wall since the start
    double wall_hit_loss = 0;            ///< J/m, kinetic energy that they lost
};

/// A named wall, over the last window.
struct WallReport {
    std::string name;
    double length = 0;    ///< m, what is left of it beside leaning solids
    double heat_flow = 0; ///< W/m, into the fluid, mean over the last window
    double heat = 0;      ///< J/m, into the fluid since the start
    Vec2 force;           ///< N/m, on the wall, mean over the last window
    double torque = 0;    ///< N, on the wall about the origin, mean over the last window
};

/// All particles in the order of their identity (constant through a run).
struct Snapshot {
    std::vector<Vec2> position;
    std::vector<Vec2> velocity;
    std::vector<double> temperature;
    std::vector<double> pressure;
};

/// CPU seconds, all threads together, spent in one phase of the step since the start.
struct Phase {
    std::string name;
    double seconds = 0;
};

} // namespace duet::fluid
