// One solid body: its mesh, its heat, and, if it is deformable, its mechanics.

#pragma once

#include "solid_solver/equilibrium.hpp"
#include "solid_solver/heat.hpp"
#include "solid_solver/implicit.hpp"
#include "solid_solver/mechanics.hpp"
#include "solid_solver/rigid.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace duet::solid {

/// Where a body's mechanical energy comes from and goes, since the start; J/m.
struct EnergyAccount {
    double interface = 0;  ///< work of the interface's forces
    double loads = 0;      ///< of body force, traction, pressure and point loads
    double supports = 0;   ///< of what moves held nodes as prescribed
    double expansion = 0;  ///< by expanding while warm: beta (T - T0) d tr(E), heat become work
    double dissipated = 0; ///< by damping, and by implicit steps
    double steps = 0;      ///< of explicit steps, see Work
    double stored = 0;     ///< change of kinetic and strain energy
    /// What the stored energy has beyond all that came in. With implicit steps the dissipated
    /// energy is what is left over, and this is zero.
    double residual() const {
        return stored - (interface + loads + supports + expansion + steps - dissipated);
    }
    EnergyAccount& operator+=(const EnergyAccount& other);
};

class Body {
  public:
    /// Throws std::invalid_argument with a sentence if the mesh or a boundary condition is at
    /// fault, or a deformable body lacks Young's modulus.
    explicit Body(BodyConfig config);
    Body(const Body&) = delete;
    Body& operator=(const Body&) = delete;

    const BodyConfig& config() const { return config_; }
    const Domains& domains() const { return domains_; }
    std::size_t nodes() const { return config_.mesh.node.size(); }
    double area() const { return area_; } ///< m2, undeformed
    double mass() const { return mass_; } ///< kg/m
    bool deformable() const { return mechanics_.has_value(); }

    /// Stiffness damping that the exchange asks for in the explicit steps from now on, s.
    void set_exchange_damping(double damping) { exchange_damping_ = damping; }
    /// Constant loads from the interface from now on: heat [N] W/m and force [N][2] N/m.
    void set_interface_load(std::span<const double> heat, std::span<const double> force);

    /// Largest stable step, s: the smaller of the thermal and the (damped, adiabatic) mechanical
    /// one; 0: no limit.
    double stable_step() const;

    /// One explicit step of length dt.
    void step(double dt);

    /// Advances by `length`; returns the number of steps. Explicit: in the least number of equal
    /// steps not longer than 0.9 of the stable one, which is looked at again every 256 steps.
    /// Implicit: in equal steps not longer than the longest asked for, halved where Newton's method
    /// does not converge. Throws std::runtime_error naming the body if the numbers are no longer
    /// finite, or no implicit step converges.
    std::uint32_t advance(double length);

    /// How an advance by `length` would be, or is, made, and why.
    struct Plan {
        bool implicit;
        double explicit_steps; ///< that it would take
        std::string reason;
    };
    Plan plan(double length) const;

    /// Puts a deformable body to rest in static equilibrium with its loads at its temperature:
    /// find_equilibrium, or, updated Lagrangian, relax. Throws std::runtime_error naming the body
    /// if there is none.
    Equilibrium find_equilibrium(double tolerance = 1e-8);
    const std::optional<Equilibrium>& equilibrium() const { return equilibrium_; } ///< at the start

    std::span<const double> temperature() const { return heat_.temperature(); } ///< [N] K
    std::span<const double> position() const;                                   ///< [N][2] m
    std::span<const double> velocity() const;                                   ///< [N][2] m/s

    const Heat& heat() const { return heat_; }
    Heat& heat() { return heat_; }
    double kinetic_energy() const; ///< J/m
    double strain_energy() const;  ///< J/m, of a rigid body that of its springs

    EnergyAccount energy() const;

    const std::optional<Rigid>& rigid() const { return rigid_; }
    const std::optional<Implicit>& implicit() const { return implicit_; }
    const std::optional<Mechanics>& mechanics() const { return mechanics_; }
    std::optional<Mechanics>& mechanics() { return mechanics_; }

    template <class Visit>
    void visit_state(const Visit& visit) {
        heat_.visit_state(visit);
        if (mechanics_) {
            mechanics_->visit_state(visit);
        }
        if (implicit_) {
            implicit_->visit_state(visit);
        }
        if (rigid_) {
            rigid_->visit_state(visit);
        }
        visit(time_);
        visit(rest_position_);
        visit(rest_velocity_);
        visit(choice_);
        visit(steps_since_update_);
    }

  private:
    void check_finite() const;
    void move_rigidly(double length);
    std::uint32_t advance_explicitly(double length);
    std::uint32_t advance_implicitly(double length);

    BodyConfig config_;
    Domains domains_;
    double area_ = mesh_area(config_.mesh), mass_ = 0;
    double exchange_damping_ = 0; ///< s
    Heat heat_;
    std::optional<Mechanics> mechanics_;
    std::optional<Implicit> implicit_;
    std::optional<Rigid> rigid_;
    std::vector<double> rest_position_, rest_velocity_; ///< of a fixed or prescribed body
    std::optional<Equilibrium> equilibrium_;
    double time_ = 0;   ///< s since the start
    double choice_ = 0; ///< of automatic stepping: 1 explicit, 2 implicit, 0 not made yet
    double steps_since_update_ = 0;
};

} // namespace duet::solid
