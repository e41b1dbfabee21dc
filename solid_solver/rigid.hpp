// Free motion of a rigid body: translation and rotation under the forces on its nodes.

#pragma once

#include "solid_solver/loads.hpp"

#include <span>
#include <vector>

namespace duet::solid {

/// M dV/dt = sum_i f_i - k d,  I dw/dt = sum_i (x_i - c) x f_i - k_angle angle, the nodes at
/// x_i = c + d + R(angle) (X_i - c). c is the centre of mass, or the pivot, which keeps its place.
/// Velocity Verlet: momentum is the impulse of the forces to rounding, and the rotation is
/// symplectic. The nodal forces are those of the interface and of the body's loads (loads.hpp).
class Rigid {
  public:
    /// At its reference place, with the momentum of the initial velocity. Throws
    /// std::invalid_argument naming the body if a boundary condition holds nodes.
    explicit Rigid(const BodyConfig& body);

    /// Constant forces on the nodes [N][2], N/m, from now on.
    void set_interface_force(std::span<const double> nodal);
    /// Advances by `length` in steps that turn it, or swing it on its springs, by a twentieth of a
    /// radian at most.
    void advance(double length);

    std::span<const double> position() const { return position_; } ///< [N][2] m
    std::span<const double> velocity() const { return velocity_; } ///< [N][2] m/s
    Point centre() const { return reference_centre_ + displacement_; }
    double angle() const { return angle_; }     ///< rad, counter-clockwise, from the start
    double spin() const { return spin_; }       ///< rad/s
    Point momentum() const;                     ///< N s/m
    double mass() const { return mass_; }       ///< kg/m
    double inertia() const { return inertia_; } ///< kg m, about the centre of mass or the pivot
    /// Of the motions along x, along y and round the centre; zero where it is held.
    const Eigen::Vector3d& inverse_mass() const { return inverse_mass_; }
    double kinetic_energy() const; ///< J/m
    double spring_energy() const;  ///< J/m
    double stored_energy() const { return kinetic_energy() + spring_energy() - start_energy_; }
    double load_work() const { return load_work_; }           ///< J/m since the start, of its loads
    double interface_work() const { return interface_work_; } ///< likewise

    template <class Visit>
    void visit_state(const Visit& visit) {
        visit(displacement_.x());
        visit(displacement_.y());
        visit(angle_);
        visit(drift_.x());
        visit(drift_.y());
        visit(spin_);
        visit(time_);
        visit(start_energy_);
        visit(load_work_);
        visit(interface_work_);
        visit(load_.force.x());
        visit(load_.force.y());
        visit(load_.across);
        visit(load_.along);
        visit(position_);
        visit(velocity_);
    }

  private:
    /// What forces on the nodes do to the whole, whatever its angle: their sum, and with the arms r
    /// of the reference place sum r x f and sum r . f, which make the torque at any angle.
    struct Net {
        Point force = Point::Zero();
        double across = 0, along = 0;
    };
    Net net(std::span<const double> nodal) const;
    Eigen::Vector3d resultant(const Net& net) const;
    void book(double half_step);
    void collect_loads();
    Eigen::Vector3d acceleration() const;
    double fastest() const;
    void place();

    double mass_ = 0, inertia_ = 0;
    Point reference_centre_ = Point::Zero();
    Eigen::Vector3d inverse_mass_, spring_; ///< along x, along y, round the centre
    std::vector<Point> arm_;                ///< [N] m, from the centre in the reference place
    Loads loads_;
    std::vector<double> external_; ///< [N][2] N/m, the loads at the present time
    Net interface_, load_;

    Point displacement_ = Point::Zero(), drift_ = Point::Zero(); ///< m, m/s, of the centre
    double angle_ = 0, spin_ = 0, time_ = 0;
    double start_energy_ = 0, load_work_ = 0, interface_work_ = 0; ///< J/m
    std::vector<double> position_, velocity_;
};

} // namespace duet::solid
