#include "solid_solver/mechanics.hpp"

#include <algorithm>
#include <cmath>

namespace duet::solid {

Mechanics::Mechanics(const BodyConfig& body,
                     const Domains& domains,
                     std::span<const double> temperature,
                     std::span<const double> capacity)
    : mass_damping_(body.mass_damping), own_damping_(body.stiffness_damping),
      damping_(own_damping_), capacity_(capacity.begin(), capacity.end()), threads_(body.threads),
      elasticity_(body, domains), spectrum_(2 * body.mesh.node.size()) {
    std::vector<double> density;
    for (const Material& m : body.materials()) {
        density.push_back(m.density);
    }
    mass_ = nodal_area(body.mesh, density); // (19)
    const std::size_t nodes = mass_.size();
    if (body.mass == Mass::corrected) {
        correction_.emplace(body.mesh, density);
        acceleration_.resize(2 * nodes);
        corrected_.resize(2 * nodes);
    }
    for (std::size_t i = 0; i < nodes; ++i) {
        for (int d = 0; d < 2; ++d) {
            reference_.push_back(body.mesh.node[i][d]);
            inverse_mass_.push_back(1 / mass_[i]);
            velocity_.push_back(body.initial_velocity(body.mesh.node[i], 0)[d]);
            displacement_.push_back(body.initial_displacement(body.mesh.node[i], 0)[d]);
        }
    }
    loads_ = Loads(body, mass_);
    for (const Loads::Held& held : loads_.held()) {
        inverse_mass_[held.component] = 0;
    }
    external_.resize(2 * nodes);
    interface_.assign(2 * nodes, 0.0);
    internal_.assign(2 * nodes, 0.0);
    position_.resize(2 * nodes);
    set_motion(std::vector<double>(displacement_), std::vector<double>(velocity_), temperature);
    frequency_ = std::sqrt(spectrum_.largest(adiabatic_tangent(), inverse_mass_));
}

void Mechanics::set_motion(std::span<const double> displacement,
                           std::span<const double> velocity,
                           std::span<const double> temperature) {
    std::copy(displacement.begin(), displacement.end(), displacement_.begin());
    std::copy(velocity.begin(), velocity.end(), velocity_.begin());
    for (const Loads::Held& held : loads_.held()) {
        if (!held.velocity) {
            displacement_[held.component] = held.value(held.place, time_);
        }
    }
    hold_velocities();
    place();
    loads_.forces(time_, position_, external_);
    // No rate yet: the damping sets in with the first step.
    elasticity_.reset(displacement_, temperature, internal_);
    start_books();
}

void Mechanics::place() {
    for (std::size_t c = 0; c < position_.size(); ++c) {
        position_[c] = reference_[c] + displacement_[c];
    }
}

void Mechanics::look_ahead(double length) {
    ahead_ = length;
    if (loads_.vary()) {
        loads_.forces(time_ + ahead_, position_, external_);
    }
}

/// The velocities of held components at the present time.
void Mechanics::hold_velocities() {
    for (const Loads::Held& held : loads_.held()) {
        const auto value = [&](double time) { return held.value(held.place, time); };
        double& velocity = velocity_[held.component];
        if (held.velocity) {
            velocity = value(time_);
        } else if (held.value.steady()) {
            velocity = 0;
        } else { // a difference over a thousandth of a step, none before the start
            const double reach = last_step_ > 0 ? 1e-3 * last_step_ : 1e-6;
            const double before = std::max(0.0, time_ - reach);
            velocity = (value(time_ + reach) - value(before)) / (time_ + reach - before);
        }
    }
}

/// The velocities that bring held components to their places a step later.
void Mechanics::hold_course(double dt) {
    if (!loads_.moves()) {
        return;
    }
    for (const Loads::Held& held : loads_.held()) {
        velocity_[held.component] =
            held.velocity
                ? held.value(held.place, time_ + 0.5 * dt)
                : (held.value(held.place, time_ + dt) - displacement_[held.component]) / dt;
    }
}

void Mechanics::set_interface_force(std::span<const double> nodal) {
    interface_.assign(nodal.begin(), nodal.end());
    loaded_.clear();
    for (std::uint32_t c = 0; c < interface_.size(); ++c) {
        if (interface_[c] != 0) {
            loaded_.push_back(c);
        }
    }
}

void Mechanics::relax(double dt, std::span<const double> temperature) {
    kick(0.5 * dt);
    for (std::size_t c = 0; c < displacement_.size(); ++c) {
        displacement_[c] += inverse_mass_[c] > 0 ? dt * velocity_[c] : 0;
    }
    place();
    if (loads_.vary()) { // a pressure follows the motion
        loads_.forces(time_, position_, external_);
    }
    elasticity_.forces(displacement_, dt, temperature, internal_);
    kick(0.5 * dt);
}

void Mechanics::settle() {
    std::fill(velocity_.begin(), velocity_.end(), 0.0);
    hold_velocities();
    elasticity_.settle(displacement_);
    start_books();
}

std::vector<double> Mechanics::reaction() const {
    std::vector<double> force(velocity_.size(), 0.0);
    for (std::size_t c = 0; c < force.size(); ++c) {
        if (inverse_mass_[c] == 0) {
            force[c] = -(load(c) + internal_[c]);
        }
    }
    return force;
}

Point Mechanics::reaction_on(std::size_t condition) const {
    Point sum = Point::Zero();
    for (const Loads::Held& held : loads_.held()) {
        if (held.condition == condition) {
            sum[static_cast<Eigen::Index>(held.component % 2)] -=
                load(held.component) + internal_[held.component];
        }
    }
    return sum;
}

/// v += half_step M^-1 f. Returns sum f^2/m.
double Mechanics::kick(double half_step) {
    double squares = 0;
    for (std::size_t c = 0; c < velocity_.size(); ++c) {
        const double force = load(c) + internal_[c];
        const double acceleration = inverse_mass_[c] * force;
        squares += force * acceleration;
        if (correction_) {
            acceleration_[c] = acceleration;
        } else {
            velocity_[c] += half_step * acceleration;
        }
    }
    if (correction_) {
        correction_->apply(acceleration_, inverse_mass_, corrected_, threads_);
        for (std::size_t c = 0; c < velocity_.size(); ++c) {
            velocity_[c] += half_step * corrected_[c];
        }
    }
    return squares;
}

/// Work of the present forces along half a step's way.
void Mechanics::book(double half_step) {
    double stress = 0, loads = 0;
    for (std::size_t c = 0; c < velocity_.size(); ++c) {
        stress += internal_[c] * velocity_[c];
        loads += external_[c] * velocity_[c];
    }
    work_.stress += half_step * stress;
    work_.loads += half_step * loads;
    if (loads_.moves()) {
        for (const Loads::Held& held : loads_.held()) {
            const std::uint32_t c = held.component;
            work_.held += half_step * (load(c) + internal_[c]) * velocity_[c];
        }
    }
}

void Mechanics::start_books() {
    work_ = {};
    held_energy_ = held_energy();
    start_energy_ = kinetic_energy() + strain_energy();
}

double Mechanics::held_energy() const {
    double energy = 0;
    for (const Loads::Held& held : loads_.held()) {
        const std::uint32_t c = held.component;
        energy += 0.5 * mass_[c / 2] * velocity_[c] * velocity_[c];
    }
    return energy;
}

// Mass-proportional damping -a M v is centred in the step: v at its start before the first half
// kick, v at its end after the second.
void Mechanics::drift(double dt) {
    slow_down(1 - 0.5 * mass_damping_ * dt);
    work_.steps -= dt * dt / 8 * kick(0.5 * dt);
    hold_course(dt);
    book(0.5 * dt);
    for (std::size_t c = 0; c < displacement_.size(); ++c) {
        displacement_[c] += dt * velocity_[c];
    }
    place();
    time_ += dt;
    last_step_ = dt;
    for (const std::uint32_t c : loaded_) {
        work_.interface += interface_[c] * dt * velocity_[c];
    }
}

void Mechanics::respond(double dt, std::span<const double> temperature) {
    if (loads_.vary()) {
        loads_.forces(time_, position_, external_);
    }
    elasticity_.forces(displacement_, dt, temperature, internal_);
    book(0.5 * dt);
    work_.steps += dt * dt / 8 * kick(0.5 * dt);
    slow_down(1 / (1 + 0.5 * mass_damping_ * dt));
    if (loads_.moves()) {
        hold_velocities();
    }
}

void Mechanics::slow_down(double factor) {
    if (mass_damping_ > 0) {
        work_.mass_damping += (1 - factor * factor) * (kinetic_energy() - held_energy());
        for (std::size_t c = 0; c < velocity_.size(); ++c) {
            velocity_[c] *= inverse_mass_[c] > 0 ? factor : 1;
        }
    }
}

void Mechanics::evaluate(std::span<const double> displacement,
                         std::span<const double> velocity,
                         std::span<const double> temperature,
                         std::span<const double> warming) {
    std::copy(displacement.begin(), displacement.end(), displacement_.begin());
    if (loads_.vary()) { // a pressure follows the motion
        place();
        loads_.forces(time_ + ahead_, position_, external_);
    }
    elasticity_.evaluate(displacement_, velocity, temperature, warming, internal_);
}

/// The tangent as the explicit time stepping sees it: the heat of a compression stays on the
/// nodes (62).
Spectrum::Operator Mechanics::adiabatic_tangent() {
    return [this](std::span<const double> u, std::span<double> force) {
        elasticity_.apply_tangent(u, force, 1, [this](std::vector<double>& nodal) {
            for (std::size_t i = 0; i < nodal.size(); ++i) {
                nodal[i] /= capacity_[i];
            }
        });
    };
}

void Mechanics::accept(double dt,
                       std::span<const double> before,
                       std::span<const double> velocity,
                       std::span<const double> temperature) {
    time_ += dt;
    last_step_ = dt;
    for (const std::uint32_t c : loaded_) {
        work_.interface += interface_[c] * (displacement_[c] - before[c]);
    }
    for (std::size_t c = 0; c < displacement_.size(); ++c) {
        const double way = displacement_[c] - before[c];
        work_.loads += external_[c] * way;
        // The mean of the squares at both ends: of second order, as the step is.
        work_.mass_damping += 0.5 * dt * mass_damping_ * mass_[c / 2]
                              * (velocity_[c] * velocity_[c] + velocity[c] * velocity[c]);
    }
    std::copy(velocity.begin(), velocity.end(), velocity_.begin());
    elasticity_.accept(displacement_, temperature);
    place();
    look_ahead(0);
}

void Mechanics::update_frequency() {
    // A few rounds from the last mode may fall a little short of the eigenvalue, so that a fall is
    // taken up by and by.
    const double now = std::sqrt(spectrum_.largest(adiabatic_tangent(), inverse_mass_, 8));
    frequency_ = std::max(now, 0.99 * frequency_);
}

void Mechanics::add_damping(double wanted) {
    damping_ = own_damping_ + (frequency_ > 0 ? std::min(wanted, 4 / frequency_) : 0);
    elasticity_.set_damping(damping_);
}

double Mechanics::stable_step() const {
    if (frequency_ == 0) {
        return 0;
    }
    const double frequency =
        correction_ ? std::sqrt(MassCorrection::growth) * frequency_ : frequency_;
    const double xi = 0.5 * damping_ * frequency;
    return 2 / frequency * (std::sqrt(1 + xi * xi) - xi);
}

double Mechanics::kinetic_energy() const {
    double energy = 0;
    for (std::size_t c = 0; c < velocity_.size(); ++c) {
        energy += 0.5 * mass_[c / 2] * velocity_[c] * velocity_[c];
    }
    return energy;
}

} // namespace duet::solid
