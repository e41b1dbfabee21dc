// Implicit steps of heat and mechanics together: TR-BDF2, of second order, L-stable, one matrix.

#pragma once

#include "solid_solver/heat.hpp"
#include "solid_solver/heat_factor.hpp"
#include "solid_solver/mechanics.hpp"
#include "solid_solver/stiffness.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace duet::solid {

/// dy/dt = f(y) by the trapezoidal rule to t + gamma dt and a second-order backward difference to
/// t + dt (Bank et al. 1985), gamma = 2 - sqrt(2); as a Runge-Kutta scheme (Hosea, Shampine 1996),
/// with tau = gamma/2 dt and w = sqrt(2)/4 dt,
///
///     y_1 = y + tau (f + f_1),     y_2 = y + w (f + f_1) + tau f_2.
///
/// What comes in over a step is a sum of rates with weights 2 w + tau = dt: impulse and heat of
/// loads that are constant over the step are the loads' own to rounding. Heat is kept as entropy,
/// y = C T + L(u) with the latent heat L of the stretching, so that thermo-elastic heating belongs
/// to the step: both fields are solved for together, and no coupling makes the step unstable.
class Implicit {
  public:
    /// `mechanics` may be null: heat alone. Both must outlive this.
    Implicit(Heat& heat, Mechanics* mechanics);

    /// One step of length dt. False if Newton's method does not converge, or the tangent is not
    /// that of a stable body; the state is then that before the step.
    bool step(double dt);

    std::uint64_t factorisations() const { return factorisations_; } ///< of the stiffness
    std::uint64_t iterations() const { return iterations_; } ///< solves with the factored stiffness

    /// The factor of the stiffness may stem from an earlier step, and the bits of a step depend on
    /// it: what it was made of belongs to the state.
    template <class Visit>
    void visit_state(const Visit& visit) {
        visit(factored_displacement_);
        visit(factored_temperature_);
        visit(factored_tau_);
    }

  private:
    using Vector = Eigen::VectorXd;

    bool start();
    bool solve_stage();
    void solve_temperature();
    bool solve_motion();
    double imbalance();
    int correct(double reduction);
    void apply(const Vector& x, Vector& image);
    bool factorise_anew();
    bool factorise_as_kept();
    void undo();

    Heat& heat_;
    Mechanics* mechanics_;
    HeatFactor heat_factor_;
    std::optional<Stiffness> stiffness_;
    double extent_ = 0; ///< m, of the body
    double tau_ = 0;    ///< s, of the present step
    double dt_ = 0;
    double stage_ = 0; ///< where the stage ends, as a share of the step

    // At the start of the step, and the rates there.
    Vector displacement_, velocity_, acceleration_, temperature_, entropy_, latent_, flow_;
    // A stage: u = from_u_ + tau v, v = from_v_ + tau a, C T + L(u) = from_entropy_ + tau q(T).
    Vector from_u_, from_v_, from_entropy_;
    Vector u_, v_, t_, stage_latent_, warming_; // what it is solved for
    Vector left_, correction_, residual_, direction_, image_, precondition_; // Newton's method

    std::vector<double> factored_displacement_, factored_temperature_;
    double factored_tau_ = 0;
    std::vector<double> at_displacement_, at_temperature_; ///< those of the factor at hand
    double at_tau_ = 0;
    std::uint64_t factorisations_ = 0, iterations_ = 0;
};

} // namespace duet::solid
