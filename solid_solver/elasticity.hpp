// Stress and internal forces of one body over its smoothing domains, in either kinematic
// description.

#pragma once

#include "solid_solver/law.hpp"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace duet::solid {

/// Total Lagrangian (the default): S of the Green-Lagrange strain of the present motion alone, P =
/// F S, on the gradients of the undeformed body. Updated Lagrangian (the paper's (7)-(9)): the
/// Cauchy stress is turned and added to step by step, on gradients of the present mesh.
class Elasticity {
  public:
    /// `domains` must outlive this. Undeformed and without stress.
    Elasticity(const BodyConfig& body, const Domains& domains);

    const Domains& domains() const { return domains_; }
    Kinematics kinematics() const { return kinematics_; }
    bool heats_itself() const { return heated_; } ///< thermo-elastic heating is on and not zero

    /// Takes `displacement` [N][2] and `temperature` [N] as where the body starts from: the updated
    /// Lagrangian stress is that of one increment from the undeformed body at T0. `force` as below.
    void reset(std::span<const double> displacement,
               std::span<const double> temperature,
               std::span<double> force);

    /// force [N][2] = -(f_int + f_damp) at `displacement` and `temperature`, after a step of length
    /// dt (0: no rate, no damping) from those of the last call: (20), and (63) with the stress rate
    /// of that step.
    void forces(std::span<const double> displacement,
                double dt,
                std::span<const double> temperature,
                std::span<double> force);

    /// W/m into each node by the compression since the last forces(), on the way to
    /// `displacement`: -beta T0 tr(E_dot) (31). Empty where the body does not heat itself.
    std::span<const double> heating(std::span<const double> displacement, double dt);

    // Total Lagrangian alone, for implicit steps and equilibrium.

    /// The same forces at a trial motion, the stress rate (63) from `velocity` and `warming` [N]
    /// K/s.
    void evaluate(std::span<const double> displacement,
                  std::span<const double> velocity,
                  std::span<const double> temperature,
                  std::span<const double> warming,
                  std::span<double> force);

    /// nodal_I = beta T0 sum_k A_k w_Ik tr(E), J/m: the heat that the nodes have given to the
    /// stretching of a motion; its fall is the thermo-elastic heating (31). Zero where the body
    /// does not heat itself.
    void latent_heat(std::span<const double> displacement, std::span<double> nodal);
    std::span<const double> latent_heat() const { return latent_; } ///< of the last whole step
    /// Ends a whole implicit step: its latent heat, and what its expansion has worked.
    void accept(std::span<const double> displacement, std::span<const double> temperature);

    // Both descriptions.

    /// What a change of heat by `nodal` [N] J/m makes of the temperatures: [N] K, in place.
    using Warming = std::function<void(std::vector<double>& nodal)>;
    /// force = K u: the change of f_int by a small displacement u [N][2] at the motion and stress
    /// of the last forces, `material` times its material part, with the temperature that the
    /// compression brings about by `warming`.
    void apply_tangent(std::span<const double> u,
                       std::span<double> force,
                       double material,
                       const Warming& warming);

    /// F - I of a domain: g.ij = du_i/dX_j.
    struct Gradient {
        double xx = 0, xy = 0, yx = 0, yy = 0;
    };
    /// Area and gradients of the shape functions of a domain.
    struct Shape {
        double area;
        std::array<double, Domains::slots> x, y;
    };
    /// What the tangent of a domain is made of, at the motion of the last forces: in the updated
    /// description the present shape, no F, and the Cauchy stress.
    struct Linearised {
        Shape shape;
        Gradient g;
        PlaneTensor stress;
        double lambda, mu; ///< isothermal
        double warming;    ///< adiabatic less isothermal lambda, beta^2 T0/(rho c)
    };
    Linearised linearised(std::size_t domain) const;

    /// Coefficient of the stiffness-proportional damping (63) from now on, s.
    void set_damping(double damping) { damping_ = damping; }
    double strain_energy() const; ///< J/m, without the thermal part of the stress
    /// J/m since the last reset or settle: sum over the steps of beta (T - T0) d tr(E),
    /// what the body has worked against its stiffness and its loads by expanding while warm.
    double expansion_work() const;
    /// J/m, likewise in explicit steps: sum over the steps of A (b dS/dt) : dE (63), the damping
    /// stress as the mean of its values at both ends of the step.
    double damping_loss() const;
    /// Forgets what the way to `displacement` would have heated and has worked.
    void settle(std::span<const double> displacement);
    /// Cauchy stress in domain k.
    PlaneTensor domain_stress(std::size_t domain, std::span<const double> temperature) const;
    /// Area-weighted mean of the domains round each node [N].
    std::vector<PlaneTensor> nodal_stress(std::span<const double> temperature) const;
    /// Green-Lagrange strain at the nodes, likewise; of plane strain (zz left out).
    std::vector<PlaneTensor> nodal_strain() const;

    template <class Visit>
    void visit_state(const Visit& visit) {
        visit(displacement_);
        visit(stress_);
        visit(out_of_plane_);
        visit(domain_temperature_);
        visit(latent_);
        visit(trace_);
        visit(warming_);
        visit(expansion_work_);
        visit(damping_stress_);
        visit(damping_loss_);
    }

  private:
    template <class OfDomain>
    std::vector<PlaneTensor> nodal_mean(const OfDomain& of_domain) const;
    const Law& law(std::size_t domain) const { return law_[domains_.part[domain]]; }
    Gradient gradient(std::size_t domain, const double* displacement) const;
    double mean(std::size_t domain, const double* nodal) const;
    void put_force(std::size_t domain, const Gradient& g, double sxx, double syy, double sxy);
    void gather(const std::vector<double>& contribution, double* nodal, int components) const;
    template <class Damping>
    void total_forces(std::span<const double> temperature, bool book, const Damping& damping);
    void book_expansion(std::size_t domain, double trace, double warming, double measure);
    void book_damping(std::size_t domain,
                      const PlaneTensor& stress,
                      const std::array<double, 3>& strain,
                      double measure);
    void updated_forces(double dt, const double* before, std::span<const double> temperature);
    Shape present_shape(std::size_t domain, const double* displacement) const;
    Shape middle_shape(std::size_t domain, const double* before, const double* after) const;
    Gradient increment(std::size_t domain,
                       const Shape& middle,
                       const double* before,
                       const double* after) const;

    const Domains& domains_;
    int threads_;
    Kinematics kinematics_;
    std::vector<Law> law_; ///< of each part of the mesh
    double reference_temperature_, damping_;
    bool heated_ = false;
    std::vector<double> reference_; ///< [N][2] m

    std::vector<double> displacement_; ///< [N][2] m, of the last forces
    std::vector<double> stress_;       ///< [K][3] xx, yy, xy; second Piola-Kirchhoff, or Cauchy
    /// [K] updated Lagrangian: sigma_zz in plane strain, the thickness' logarithm in plane stress
    std::vector<double> out_of_plane_;
    std::vector<double> domain_temperature_; ///< [K] updated Lagrangian: at the last forces
    std::vector<double> latent_;             ///< [N] J/m, at the last call of heating
    /// [K], or empty where no warming expands the body: tr(E) (total Lagrangian) and T - T0 of the
    /// last forces, and the expansion work J/m.
    std::vector<double> trace_, warming_, expansion_work_;
    std::vector<double> damping_stress_; ///< [K][3] b dS/dt of the last forces
    std::vector<double> damping_loss_;   ///< [K] J/m

    std::vector<double> before_;       ///< [N][2] work space
    std::vector<double> contribution_; ///< [K][slots][2]
    std::vector<double> heat_share_;   ///< [K][slots]
    std::vector<double> heating_;      ///< [N]
    std::vector<double> nodal_change_; ///< [N]
};

} // namespace duet::solid
