// Motion of one thermo-elastic body: lumped mass, loads, explicit central difference.

#pragma once

#include "solid_solver/elasticity.hpp"
#include "solid_solver/loads.hpp"
#include "solid_solver/mass_correction.hpp"
#include "solid_solver/spectrum.hpp"

#include <optional>
#include <span>
#include <vector>

namespace duet::solid {

/// Work on a body since the start, by its way; J/m. Explicit steps: each force at the start of a
/// step and at its end, against half the step's way. Then the change of the kinetic energy is
///
///     interface + loads + supports + stress - mass_damping + steps
///
/// to rounding, with a lumped mass: v' = v + h a/2, x += h v', v = v' + h a'/2 give
/// m (v^2 - v0^2)/2 = (f0 + f) (x - x0)/2 + h^2/8 (f^2 - f0^2)/m, whose last part is that of the
/// steps: it stays bounded, and is of second order.
struct Work {
    double interface = 0;
    double loads = 0;  ///< body force, traction, pressure, point loads
    double held = 0;   ///< of all forces on held nodes along their way; their supports' is minus it
    double stress = 0; ///< explicit steps: of the body's own stress, damping included
    double mass_damping = 0; ///< lost
    double steps = 0;

    template <class Visit>
    void visit_state(const Visit& visit) {
        visit(interface);
        visit(loads);
        visit(held);
        visit(stress);
        visit(mass_damping);
        visit(steps);
    }
};

class Mechanics {
  public:
    /// At rest in the reference positions but for the initial velocity, at `temperature` [N].
    /// `domains` must outlive this.
    Mechanics(const BodyConfig& body,
              const Domains& domains,
              std::span<const double> temperature,
              std::span<const double> capacity);

    /// Constant forces on the nodes [N][2], N/m, from now on.
    void set_interface_force(std::span<const double> nodal);

    // A step from t to t + dt is drift, heating, (the heat's own step,) respond.
    // Velocities are kept at whole steps: v += dt/2 a, x += dt v, new a, v += dt/2 a.

    /// Half a kick with the forces at t, then positions at t + dt.
    void drift(double dt);
    /// W/m into each node by the compression of this step, -beta T0 tr(E_dot) (31).
    std::span<const double> heating(double dt) { return elasticity_.heating(displacement_, dt); }
    /// Forces at t + dt from the new positions and temperatures, and the other half of the kick.
    void respond(double dt, std::span<const double> temperature);

    /// A step on the way to equilibrium: only the free components move, loads and temperature stay
    /// those of the present time, and nothing is booked.
    void relax(double dt, std::span<const double> temperature);
    /// At rest where it is; held components keep the velocities that their conditions tell. What
    /// the stretching on the way would have heated is forgotten.
    void settle();

    /// (2/w) (sqrt(1 + xi^2) - xi), xi = b w/2, with the largest adiabatic frequency w at the last
    /// estimate.
    double stable_step() const;
    /// Takes up the present deformation into the largest frequency (a few rounds only).
    void update_frequency();

    std::span<const double> position() const { return position_; } ///< [N][2] m
    std::span<const double> velocity() const { return velocity_; } ///< [N][2] m/s
    std::span<const double> mass() const { return mass_; }         ///< [N] kg/m
    /// [N][2] N/m, -(f_int + f_damp): what the body's own stress does to its nodes.
    std::span<const double> internal_force() const { return internal_; }
    double kinetic_energy() const;                                       ///< J/m
    double strain_energy() const { return elasticity_.strain_energy(); } ///< J/m
    /// J/m, kinetic and strain, since the start.
    double stored_energy() const { return kinetic_energy() + strain_energy() - start_energy_; }
    const Work& work() const { return work_; }
    /// J/m that what holds the held nodes has done on them: against the forces there, and to move
    /// their mass.
    double support_work() const { return held_energy() - held_energy_ - work_.held; }
    PlaneTensor domain_stress(std::size_t domain, std::span<const double> temperature) const {
        return elasticity_.domain_stress(domain, temperature);
    }
    std::vector<PlaneTensor> nodal_stress(std::span<const double> temperature) const {
        return elasticity_.nodal_stress(temperature);
    }

    /// Replaces the state: displacement and velocity [N][2]; held components follow their
    /// conditions.
    void set_motion(std::span<const double> displacement,
                    std::span<const double> velocity,
                    std::span<const double> temperature);

    template <class Visit>
    void visit_state(const Visit& visit) {
        visit(displacement_);
        visit(position_);
        visit(velocity_);
        visit(internal_);
        elasticity_.visit_state(visit);
        visit(external_);
        visit(time_);
        visit(last_step_);
        work_.visit_state(visit);
        visit(held_energy_);
        visit(start_energy_);
        visit(frequency_);
        visit(spectrum_.mode());
    }

    /// -(f_int + f_damp) at a trial motion, into internal_force(): `displacement` and `velocity`
    /// [N][2] and the temperature [N] with its rate [N] K/s. The velocity counts for the damping
    /// alone, with the stress rate (63) of the motion itself.
    void evaluate(std::span<const double> displacement,
                  std::span<const double> velocity,
                  std::span<const double> temperature,
                  std::span<const double> warming);

    /// Loads that change in time are from now on those of `length` s after the present time.
    void look_ahead(double length);
    /// Some held component moves: a displacement that changes in time, or a velocity.
    bool driven() const { return loads_.moves(); }
    /// Ends an implicit step of length dt at the motion of the last evaluate, with `velocity`.
    void accept(double dt,
                std::span<const double> before,
                std::span<const double> velocity,
                std::span<const double> temperature);
    double mass_damping() const { return mass_damping_; } ///< 1/s
    double stiffness_damping() const { return damping_; } ///< s
    /// Adds `wanted` s to the body's own stiffness damping, or less: at most twice the critical
    /// damping of the fastest vibration, which leaves a quarter of the stable step.
    void add_damping(double wanted);

    const Elasticity& elasticity() const { return elasticity_; }
    Elasticity& elasticity() { return elasticity_; }
    std::span<const double> inverse_mass() const { return inverse_mass_; } ///< [N][2], 0 where held
    std::span<const double> displacement() const { return displacement_; } ///< [N][2] m
    /// [N][2] N/m: what holds the held components against loads and stress, zero elsewhere.
    std::vector<double> reaction() const;
    /// The sum of these over the nodes that the boundary `condition` of the config holds, N/m.
    Point reaction_on(std::size_t condition) const;
    /// [N][2] N/m: body force, traction and interface.
    double load(std::size_t component) const {
        return external_[component] + interface_[component];
    }

  private:
    Spectrum::Operator adiabatic_tangent();
    void hold_velocities();
    void hold_course(double dt);
    double kick(double half_step);
    void book(double half_step);
    double held_energy() const;
    void start_books();
    void slow_down(double factor);
    void place(); ///< positions from the displacement

    double mass_damping_;
    double own_damping_, damping_; ///< s, of the body, and with what the exchange asks for

    std::vector<double> reference_;    ///< [N][2] m
    std::vector<double> mass_;         ///< [N]
    std::vector<double> inverse_mass_; ///< [N][2], zero where held
    std::vector<double> capacity_;     ///< [N] J/(m K)
    Loads loads_;
    std::vector<double> external_;      ///< [N][2] N/m: the loads at the present time
    std::vector<double> interface_;     ///< [N][2] N/m
    std::vector<std::uint32_t> loaded_; ///< components of interface_ that are not zero

    /// [N][2]. The displacement is kept for itself: small strains would drown in the rounding of
    /// differences of positions.
    std::vector<double> displacement_, position_, velocity_;
    std::vector<double> internal_; ///< [N][2] N/m, -(f_int + f_damp) at the last positions
    Work work_;
    double held_energy_ = 0;  ///< J/m, kinetic, of the held nodes at the start
    double start_energy_ = 0; ///< J/m, kinetic and strain
    double time_ = 0;         ///< s since the start
    double last_step_ = 0;    ///< s
    double ahead_ = 0;        ///< s, within an implicit step
    double frequency_ = 0;
    std::optional<MassCorrection> correction_;
    std::vector<double> acceleration_, corrected_; ///< [N][2] work space of the correction
    int threads_;
    Elasticity elasticity_;
    Spectrum spectrum_;
};

} // namespace duet::solid
