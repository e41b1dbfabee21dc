// All solid bodies of a scene and their interface with the fluid.

#pragma once

#include "solid_solver/body.hpp"
#include "solid_solver/interface.hpp"

#include <deque>
#include <span>
#include <vector>

namespace duet::solid {

/// What has passed through the interface since the start.
struct InterfaceAccount {
    double heat = 0;           ///< J/m, into the solid
    double exchanged_heat = 0; ///< J/m, sum of absolute values over segments and windows
    double impulse_x = 0;      ///< N s/m, on the solid, held or not
    double impulse_y = 0;
    double exchanged_impulse = 0; ///< N s/m, sum of absolute values over nodes and windows
    double work = 0;              ///< J/m, sum of force times the way of its node in the window
};

class Solid {
  public:
    /// `region`: corners of the fluid's cavity; empty: there is no fluid, and no interface.
    /// Throws std::invalid_argument with a sentence.
    Solid(std::vector<BodyConfig> bodies, const std::vector<Point>& region);

    std::deque<Body>& bodies() { return bodies_; }
    const std::deque<Body>& bodies() const { return bodies_; }
    const Interface& interface() const { return interface_; }

    /// Advances all bodies by `length` under constant loads: force [nodes][2] N/m and heat_flow
    /// [segments] W/m of the interface, both into the solid. A segment's heat goes in halves to its
    /// nodes: the linear shape functions under a uniform flux (55). Returns the largest
    /// number of steps that a body took.
    /// `impedance` of the fluid, Pa s/m: what the exchange would feed, vibrations faster than a
    /// window, is damped accordingly (explicit steps of deformable bodies); 0: nothing is.
    std::uint32_t advance(double length,
                          std::span<const double> force,
                          std::span<const double> heat_flow,
                          double impedance = 0);

    /// State of the interface: position [N][2], velocity [N][2], temperature [N].
    void interface_state(std::vector<double>& position,
                         std::vector<double>& velocity,
                         std::vector<double>& temperature) const;

    /// Longest window for which the first layer of nodes cannot overshoot against a fluid of
    /// conductivity `conductivity` and particle spacing `spacing` (method, section 3):
    /// rho c dx_s/2 >= 2 window k_f / (dx/2), dx_s the length of a wet edge. Insulated bodies do
    /// not limit it. 0: no limit.
    double exchange_limit(double conductivity, double spacing) const;

    /// Longest window for which the reaction of the fluid, frozen in it, stays lighter than the
    /// first layer of a deformable body (method, section 3): rho dx_s >= rho_f c window, or than a
    /// rigid body as a whole: 1 >= window lambda_max of M^-1 Z, Z = rho_f c sum ds g g^T over its
    /// wet edges, g = (n, r x n) with the normal n and the arm r. 0: no limit.
    double added_mass_limit(double fluid_density, double sound_speed) const;

    /// Longest window for which the drag of a fluid of dynamic viscosity `viscosity` and particle
    /// spacing `spacing`, frozen in it, cannot turn the first layer of a deformable body back:
    /// rho dx_s/2 >= 2 window mu / (dx/2), twice what is stable at all where the fluid goes ahead
    /// in a motion with the acceleration of the window before. 0: no limit.
    double drag_limit(double viscosity, double spacing) const;

    const InterfaceAccount& account() const { return account_; }

    template <class Visit>
    void visit_state(const Visit& visit) {
        for (Body& body : bodies_) {
            body.visit_state(visit);
        }
        visit(account_.heat);
        visit(account_.exchanged_heat);
        visit(account_.impulse_x);
        visit(account_.impulse_y);
        visit(account_.exchanged_impulse);
        visit(account_.work);
    }

  private:
    template <class Limit>
    double least_over_segments(const Limit& limit) const;
    /// 1/s: how fast a wall that answers its velocity by `across` Pa s/m against the normal and by
    /// `along_it` along itself stops a rigid body at most, lambda_max of sum ds M^-1 (across n n^T
    /// + along_it t t^T) over its three motions; see added_mass_limit and drag_limit.
    double rigid_rate(double across, double along_it) const;
    void damp_exchange(double length, double impedance);
    void set_loads(std::span<const double> force, std::span<const double> heat_flow);
    void book(double length, std::span<const double> force, std::span<const double> heat_flow);

    std::deque<Body> bodies_; // a deque: bodies stay where they are
    Interface interface_;
    std::vector<std::vector<double>> nodal_heat_, nodal_force_; ///< of each body
    std::vector<double> wet_length_;                            ///< m, of each body
    InterfaceAccount account_;
    /// Of the interface, at the start of a window and at its end; work space.
    std::vector<double> position_before_, position_, velocity_, temperature_;
};

} // namespace duet::solid
