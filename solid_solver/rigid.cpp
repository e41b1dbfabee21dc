#include "solid_solver/rigid.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace duet::solid {

namespace {

double cross(const Point& a, const Point& b) {
    return a.x() * b.y() - a.y() * b.x();
}

} // namespace

Rigid::Rigid(const BodyConfig& body) {
    const Mesh& mesh = body.mesh;
    std::vector<double> density;
    for (const Material& material : body.materials()) {
        density.push_back(material.density);
    }
    const std::vector<double> nodal = nodal_area(mesh, density); // thirds keep the first moment
    Point moment = Point::Zero();
    for (std::size_t i = 0; i < nodal.size(); ++i) {
        mass_ += nodal[i];
        moment += nodal[i] * mesh.node[i];
    }
    const Point middle = moment / mass_;
    reference_centre_ = body.support.pivot.value_or(middle);
    for (const Point& p : mesh.node) {
        arm_.push_back(p - reference_centre_);
    }
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
        const auto& [i, j, k] = mesh.triangle[t];
        const Point &a = arm_[i], &b = arm_[j], &c = arm_[k];
        inertia_ += density[mesh.part_of(t)] * triangle_area(mesh, mesh.triangle[t]) / 6
                    * (a.dot(a) + b.dot(b) + c.dot(c) + a.dot(b) + b.dot(c) + c.dot(a));
    }
    const Support& support = body.support;
    const bool hinged = support.pivot.has_value();
    inverse_mass_ = {support.fixed_x || hinged ? 0 : 1 / mass_,
                     support.fixed_y || hinged ? 0 : 1 / mass_,
                     support.fixed_angle ? 0 : 1 / inertia_};
    spring_ = {support.spring_x, support.spring_y, support.spring_angle};

    loads_ = Loads(body, nodal);
    if (!loads_.held().empty()) {
        throw std::invalid_argument("Body '" + body.name
                                    + "' is rigid: a boundary condition cannot hold its nodes; "
                                      "say in its support what holds it.");
    }
    external_.resize(2 * arm_.size());
    position_.resize(2 * arm_.size());
    velocity_.resize(2 * arm_.size());

    // The rigid motion of the same momentum and spin.
    double spin = 0, lumped = 0;
    for (std::size_t i = 0; i < arm_.size(); ++i) {
        const Point v = body.initial_velocity(mesh.node[i], 0);
        drift_ += nodal[i] / mass_ * v;
        spin += nodal[i] * cross(arm_[i], v);
        lumped += nodal[i] * arm_[i].squaredNorm();
    }
    drift_ = (inverse_mass_.head<2>().array() > 0).select(drift_, 0.0);
    spin_ = support.fixed_angle ? 0 : spin / lumped;
    start_energy_ = kinetic_energy();
    place();
    collect_loads();
}

Rigid::Net Rigid::net(std::span<const double> nodal) const {
    Net sum;
    for (std::size_t i = 0; i < arm_.size(); ++i) {
        const Point f(nodal[2 * i], nodal[2 * i + 1]);
        sum.force += f;
        sum.across += cross(arm_[i], f);
        sum.along += arm_[i].dot(f);
    }
    return sum;
}

void Rigid::set_interface_force(std::span<const double> nodal) {
    interface_ = net(nodal);
}

void Rigid::collect_loads() {
    loads_.forces(time_, position_, external_);
    load_ = net(external_);
}

/// Force and torque, with (R r) x f = cos(angle) r x f - sin(angle) r . f.
Eigen::Vector3d Rigid::resultant(const Net& net) const {
    return {
        net.force.x(), net.force.y(), std::cos(angle_) * net.across - std::sin(angle_) * net.along};
}

Eigen::Vector3d Rigid::acceleration() const {
    const Eigen::Vector3d way(displacement_.x(), displacement_.y(), angle_);
    return inverse_mass_.cwiseProduct(resultant(interface_) + resultant(load_)
                                      - spring_.cwiseProduct(way));
}

/// Work of the present forces along half a step's way.
void Rigid::book(double half_step) {
    const Eigen::Vector3d way = half_step * Eigen::Vector3d(drift_.x(), drift_.y(), spin_);
    load_work_ += resultant(load_).dot(way);
    interface_work_ += resultant(interface_).dot(way);
}

/// rad/s: the frequency of its springs or of a swing in its forces, or the spin itself.
double Rigid::fastest() const {
    const double swing =
        inverse_mass_.z()
        * std::hypot(interface_.across + load_.across, interface_.along + load_.along);
    const double squares = std::max(inverse_mass_.cwiseProduct(spring_).maxCoeff(), swing);
    return std::max(std::sqrt(squares), std::abs(spin_));
}

void Rigid::advance(double length) {
    constexpr double largest_turn = 0.05; // rad: the frequency is off by the square of it over 24
    const double steps = std::max(1.0, std::ceil(length * fastest() / largest_turn));
    const double dt = length / steps;
    for (double i = 0; i < steps; ++i) {
        const Eigen::Vector3d before = acceleration();
        drift_ += 0.5 * dt * before.head<2>();
        spin_ += 0.5 * dt * before.z();
        book(0.5 * dt);
        displacement_ += dt * drift_;
        angle_ += dt * spin_;
        time_ += dt;
        if (loads_.vary()) {
            place();
            collect_loads();
        }
        book(0.5 * dt);
        const Eigen::Vector3d after = acceleration();
        drift_ += 0.5 * dt * after.head<2>();
        spin_ += 0.5 * dt * after.z();
    }
    place();
}

void Rigid::place() {
    const Eigen::Rotation2Dd turn(angle_);
    for (std::size_t i = 0; i < arm_.size(); ++i) {
        const Point arm = turn * arm_[i];
        const Point x = centre() + arm;
        const Point v = drift_ + spin_ * Point(-arm.y(), arm.x());
        for (std::size_t d = 0; d < 2; ++d) {
            const auto k = static_cast<Eigen::Index>(d);
            position_[2 * i + d] = x[k];
            velocity_[2 * i + d] = v[k];
        }
    }
}

Point Rigid::momentum() const {
    return mass_ * drift_;
}

double Rigid::kinetic_energy() const {
    return 0.5 * (mass_ * drift_.squaredNorm() + inertia_ * spin_ * spin_);
}

double Rigid::spring_energy() const {
    const Eigen::Vector3d way(displacement_.x(), displacement_.y(), angle_);
    return 0.5 * way.dot(spring_.cwiseProduct(way));
}

} // namespace duet::solid
