#include "solid_solver/mechanics.hpp"

#include "solid_solver/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace duet::solid {

namespace {
constexpr std::size_t slots = Domains::slots;

/// The change of E = (F^T F - I)/2 at F = I + g by a change d of F: xx, yy, xy.
std::array<double, 3> strain_change(const Mechanics::Gradient& g, const Mechanics::Gradient& d) {
    return {(1 + g.xx) * d.xx + g.yx * d.yx,
            g.xy * d.xy + (1 + g.yy) * d.yy,
            0.5 * ((1 + g.xx) * d.xy + g.yx * d.yy + g.xy * d.xx + (1 + g.yy) * d.yx)};
}
} // namespace

double PlaneTensor::von_mises() const {
    return std::sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx))
                     + 3 * xy * xy);
}

Mechanics::Mechanics(const BodyConfig& body,
                     const Domains& domains,
                     std::span<const double> temperature,
                     std::span<const double> capacity)
    : domains_(domains), threads_(body.threads), reference_temperature_(body.reference_temperature),
      damping_(body.stiffness_damping), mass_damping_(body.mass_damping),
      capacity_(capacity.begin(), capacity.end()), spectrum_(2 * body.mesh.node.size()) {
    std::vector<double> density;
    for (const Material& m : body.materials()) {
        density.push_back(m.density);
        law_.push_back({m.lambda(), m.mu(), m.beta(), m.density * m.heat_capacity});
        heated_ = heated_ || (body.thermoelastic_heating && m.beta() * reference_temperature_ != 0);
    }
    mass_ = nodal_area(body.mesh, density); // (19)
    const std::size_t nodes = mass_.size();
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
    stress_.assign(3 * domains.size(), 0.0);
    latent_.assign(nodes, 0.0);
    contribution_.resize(2 * slots * domains.size());
    heat_share_.resize(slots * domains.size());
    heating_.resize(nodes);
    nodal_change_.resize(nodes);
    set_motion(std::vector<double>(displacement_), std::vector<double>(velocity_), temperature);
    frequency_ = std::sqrt(spectrum_.largest(
        [this](const double* u, double* f) { apply_adiabatic_tangent(u, f); }, inverse_mass_));
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
    compute_forces(0, temperature); // no rate yet: the damping sets in with the first step
    latent_heat(displacement_, latent_);
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

void Mechanics::kick(double half_step) {
    for (std::size_t c = 0; c < velocity_.size(); ++c) {
        velocity_[c] +=
            half_step * inverse_mass_[c] * (external_[c] + interface_[c] + internal_[c]);
    }
}

// Mass-proportional damping -a M v is centred in the step: v at its start before the first half
// kick, v at its end after the second.
void Mechanics::drift(double dt) {
    slow_down(1 - 0.5 * mass_damping_ * dt);
    kick(0.5 * dt);
    hold_course(dt);
    for (std::size_t c = 0; c < displacement_.size(); ++c) {
        displacement_[c] += dt * velocity_[c];
    }
    place();
    time_ += dt;
    last_step_ = dt;
    for (const std::uint32_t c : loaded_) {
        work_ += interface_[c] * dt * velocity_[c];
        impulse_[c % 2] += interface_[c] * dt;
    }
}

void Mechanics::respond(double dt, std::span<const double> temperature) {
    if (loads_.vary()) {
        loads_.forces(time_, position_, external_);
    }
    compute_forces(dt, temperature);
    kick(0.5 * dt);
    slow_down(1 / (1 + 0.5 * mass_damping_ * dt));
    if (loads_.moves()) {
        hold_velocities();
    }
}

void Mechanics::slow_down(double factor) {
    if (mass_damping_ > 0) {
        for (double& v : velocity_) {
            v *= factor;
        }
    }
}

Mechanics::Gradient Mechanics::displacement_gradient(std::size_t k, const double* u) const {
    const auto& node = domains_.node[k];
    const auto &x = domains_.gradient_x[k], &y = domains_.gradient_y[k];
    Gradient g{0, 0, 0, 0};
    for (std::size_t s = 0; s < slots; ++s) {
        const double ux = u[2 * node[s]], uy = u[2 * node[s] + 1];
        g.xx += ux * x[s];
        g.xy += ux * y[s];
        g.yx += uy * x[s];
        g.yy += uy * y[s];
    }
    return g;
}

double Mechanics::domain_temperature(std::size_t k, std::span<const double> temperature) const {
    double mean = 0;
    for (std::size_t s = 0; s < slots; ++s) {
        mean += domains_.weight[k][s] * temperature[domains_.node[k][s]];
    }
    return mean;
}

/// S = lambda tr(E) I + 2 mu E - beta (T - T0) I, E = (g + g^T + g^T g)/2, g = F - I.
PlaneTensor Mechanics::second_piola(std::size_t k, const Gradient& g, double temperature) const {
    const Law& m = law(k);
    const double exx = g.xx + 0.5 * (g.xx * g.xx + g.yx * g.yx);
    const double eyy = g.yy + 0.5 * (g.xy * g.xy + g.yy * g.yy);
    const double exy = 0.5 * (g.xy + g.yx + g.xx * g.xy + g.yx * g.yy);
    const double mean = m.lambda * (exx + eyy) - m.beta * (temperature - reference_temperature_);
    return {mean + 2 * m.mu * exx, mean + 2 * m.mu * eyy, 2 * m.mu * exy, mean};
}

/// The domain's share of -f_int: -A P gradN_I with P = F S, for each of its nodes (20).
void Mechanics::put_force(std::size_t k, const Gradient& g, double sxx, double syy, double sxy) {
    const double area = domains_.area[k];
    const double fxx = 1 + g.xx, fyy = 1 + g.yy;
    const double pxx = area * (fxx * sxx + g.xy * sxy), pxy = area * (fxx * sxy + g.xy * syy);
    const double pyx = area * (g.yx * sxx + fyy * sxy), pyy = area * (g.yx * sxy + fyy * syy);
    const auto &x = domains_.gradient_x[k], &y = domains_.gradient_y[k];
    double* out = &contribution_[2 * slots * k];
    for (std::size_t s = 0; s < slots; ++s) {
        out[2 * s] = -(pxx * x[s] + pxy * y[s]);
        out[2 * s + 1] = -(pyx * x[s] + pyy * y[s]);
    }
}

/// nodal_I = sum of what the domains round I contribute, in the order of the domains.
void Mechanics::gather(const std::vector<double>& contribution,
                       double* nodal,
                       int components) const {
    const auto width = static_cast<std::size_t>(components);
    in_pieces(domains_.first.size() - 1, threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t d = 0; d < width; ++d) {
                double sum = 0;
                for (std::uint32_t e = domains_.first[i]; e < domains_.first[i + 1]; ++e) {
                    sum += contribution[width * domains_.entry[e] + d];
                }
                nodal[width * i + d] = sum;
            }
        }
    });
}

/// Internal forces (20) and stiffness-proportional damping (63), its stress rate taken over the
/// step that has just been made: P = F (S + b dS/dt).
void Mechanics::compute_forces(double dt, std::span<const double> temperature) {
    const double per_step = dt > 0 ? damping_ / dt : 0;
    in_pieces(domains_.size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Gradient g = displacement_gradient(k, displacement_.data());
            const PlaneTensor s = second_piola(k, g, domain_temperature(k, temperature));
            double* old = &stress_[3 * k];
            put_force(k,
                      g,
                      s.xx + per_step * (s.xx - old[0]),
                      s.yy + per_step * (s.yy - old[1]),
                      s.xy + per_step * (s.xy - old[2]));
            old[0] = s.xx;
            old[1] = s.yy;
            old[2] = s.xy;
        }
    });
    gather(contribution_, internal_.data(), 2);
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
    for (std::size_t k = 0; k < domains_.size(); ++k) {
        const Gradient g = displacement_gradient(k, displacement_.data());
        const PlaneTensor s = second_piola(k, g, domain_temperature(k, temperature));
        stress_[3 * k] = s.xx;
        stress_[3 * k + 1] = s.yy;
        stress_[3 * k + 2] = s.xy;
        std::array<double, 3> rate{};
        if (damping_ > 0) {
            const auto e = strain_change(g, displacement_gradient(k, velocity.data()));
            const Law& m = law(k);
            const double mean = m.lambda * (e[0] + e[1]) - m.beta * domain_temperature(k, warming);
            rate = {mean + 2 * m.mu * e[0], mean + 2 * m.mu * e[1], 2 * m.mu * e[2]};
        }
        put_force(
            k, g, s.xx + damping_ * rate[0], s.yy + damping_ * rate[1], s.xy + damping_ * rate[2]);
    }
    gather(contribution_, internal_.data(), 2);
}

Mechanics::Linearised Mechanics::linearised(std::size_t k) const {
    const Law& m = law(k);
    const double warming = heated_ ? m.beta * m.beta * reference_temperature_ / m.heat_capacity : 0;
    return {domains_.area[k],
            domains_.gradient_x[k],
            domains_.gradient_y[k],
            displacement_gradient(k, displacement_.data()),
            {stress_[3 * k], stress_[3 * k + 1], stress_[3 * k + 2], 0},
            m.lambda,
            m.mu,
            warming};
}

std::span<const double> Mechanics::heating(double dt) {
    if (!heated_) {
        return {};
    }
    latent_heat(displacement_, heating_);
    for (std::size_t i = 0; i < latent_.size(); ++i) {
        const double before = latent_[i];
        latent_[i] = heating_[i];
        heating_[i] = (before - latent_[i]) / dt;
    }
    return heating_;
}

void Mechanics::latent_heat(std::span<const double> displacement, std::span<double> nodal) {
    if (!heated_) {
        std::fill(nodal.begin(), nodal.end(), 0.0);
        return;
    }
    in_pieces(domains_.size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Gradient g = displacement_gradient(k, displacement.data());
            const double trace =
                g.xx + g.yy + 0.5 * (g.xx * g.xx + g.yx * g.yx + g.xy * g.xy + g.yy * g.yy);
            const double heat = law(k).beta * reference_temperature_ * domains_.area[k] * trace;
            for (std::size_t s = 0; s < slots; ++s) {
                heat_share_[slots * k + s] = heat * domains_.weight[k][s];
            }
        }
    });
    gather(heat_share_, nodal.data(), 1);
}

void Mechanics::apply_tangent(const double* u,
                              double* force,
                              double material,
                              const Warming& warming) {
    if (heated_) {
        for (std::size_t k = 0; k < domains_.size(); ++k) {
            const auto e = strain_change(displacement_gradient(k, displacement_.data()),
                                         displacement_gradient(k, u));
            const double heat =
                -law(k).beta * reference_temperature_ * domains_.area[k] * (e[0] + e[1]);
            for (std::size_t s = 0; s < slots; ++s) {
                heat_share_[slots * k + s] = heat * domains_.weight[k][s];
            }
        }
        gather(heat_share_, nodal_change_.data(), 1);
        warming(nodal_change_);
    }
    for (std::size_t k = 0; k < domains_.size(); ++k) {
        const Gradient g = displacement_gradient(k, displacement_.data());
        const Gradient d = displacement_gradient(k, u);
        const auto e = strain_change(g, d);
        const Law& m = law(k);
        const double warmer = heated_ ? domain_temperature(k, nodal_change_) : 0;
        const double mean = material * m.lambda * (e[0] + e[1]) - m.beta * warmer;
        const double twice = 2 * material * m.mu;
        put_force(k, g, mean + twice * e[0], mean + twice * e[1], twice * e[2]);
        // dF S: the stress that is there already, turned with the material.
        const double* s = &stress_[3 * k];
        const double area = domains_.area[k];
        const double pxx = area * (d.xx * s[0] + d.xy * s[2]);
        const double pxy = area * (d.xx * s[2] + d.xy * s[1]);
        const double pyx = area * (d.yx * s[0] + d.yy * s[2]);
        const double pyy = area * (d.yx * s[2] + d.yy * s[1]);
        double* out = &contribution_[2 * slots * k];
        for (std::size_t i = 0; i < slots; ++i) {
            out[2 * i] -= pxx * domains_.gradient_x[k][i] + pxy * domains_.gradient_y[k][i];
            out[2 * i + 1] -= pyx * domains_.gradient_x[k][i] + pyy * domains_.gradient_y[k][i];
        }
    }
    gather(contribution_, force, 2);
    for (std::size_t c = 0; c < position_.size(); ++c) {
        force[c] = -force[c];
    }
}

/// The tangent as the explicit time stepping sees it: the heat of a compression stays on the
/// nodes (62).
void Mechanics::apply_adiabatic_tangent(const double* u, double* force) {
    apply_tangent(u, force, 1, [this](std::vector<double>& nodal) {
        for (std::size_t i = 0; i < nodal.size(); ++i) {
            nodal[i] /= capacity_[i];
        }
    });
}

void Mechanics::accept(double dt,
                       std::span<const double> before,
                       std::span<const double> velocity) {
    time_ += dt;
    last_step_ = dt;
    for (const std::uint32_t c : loaded_) {
        work_ += interface_[c] * (displacement_[c] - before[c]);
        impulse_[c % 2] += interface_[c] * dt;
    }
    std::copy(velocity.begin(), velocity.end(), velocity_.begin());
    latent_heat(displacement_, latent_);
    place();
    look_ahead(0);
}

void Mechanics::update_frequency() {
    const double now = std::sqrt(spectrum_.largest(
        [this](const double* u, double* f) { apply_adiabatic_tangent(u, f); }, inverse_mass_, 10));
    // Ten rounds from the last mode may fall a little short of the eigenvalue, so that a fall is
    // taken up by and by.
    frequency_ = std::max(now, 0.99 * frequency_);
}

double Mechanics::stable_step() const {
    if (frequency_ == 0) {
        return 0;
    }
    const double xi = 0.5 * damping_ * frequency_;
    return 2 / frequency_ * (std::sqrt(1 + xi * xi) - xi);
}

double Mechanics::kinetic_energy() const {
    double energy = 0;
    for (std::size_t c = 0; c < velocity_.size(); ++c) {
        energy += 0.5 * mass_[c / 2] * velocity_[c] * velocity_[c];
    }
    return energy;
}

double Mechanics::strain_energy() const {
    double energy = 0;
    for (std::size_t k = 0; k < domains_.size(); ++k) {
        const Gradient g = displacement_gradient(k, displacement_.data());
        const double exx = g.xx + 0.5 * (g.xx * g.xx + g.yx * g.yx);
        const double eyy = g.yy + 0.5 * (g.xy * g.xy + g.yy * g.yy);
        const double exy = 0.5 * (g.xy + g.yx + g.xx * g.xy + g.yx * g.yy);
        energy += domains_.area[k]
                  * (0.5 * law(k).lambda * (exx + eyy) * (exx + eyy)
                     + law(k).mu * (exx * exx + eyy * eyy + 2 * exy * exy));
    }
    return energy;
}

/// sigma = F S F^T / J; out of the plane F is one.
PlaneTensor Mechanics::domain_stress(std::size_t k, std::span<const double> temperature) const {
    const Gradient g = displacement_gradient(k, displacement_.data());
    const PlaneTensor s = second_piola(k, g, domain_temperature(k, temperature));
    const double fxx = 1 + g.xx, fyy = 1 + g.yy;
    const double jacobian = fxx * fyy - g.xy * g.yx;
    const double pxx = fxx * s.xx + g.xy * s.xy, pxy = fxx * s.xy + g.xy * s.yy;
    const double pyx = g.yx * s.xx + fyy * s.xy, pyy = g.yx * s.xy + fyy * s.yy;
    return {(pxx * fxx + pxy * g.xy) / jacobian,
            (pyx * g.yx + pyy * fyy) / jacobian,
            (pxx * g.yx + pxy * fyy) / jacobian,
            s.zz / jacobian};
}

std::vector<PlaneTensor> Mechanics::nodal_stress(std::span<const double> temperature) const {
    std::vector<PlaneTensor> nodal(mass_.size());
    std::vector<double> area(mass_.size(), 0.0);
    for (std::size_t k = 0; k < domains_.size(); ++k) {
        const PlaneTensor s = domain_stress(k, temperature);
        for (std::size_t i = 0; i < slots; ++i) {
            const std::uint32_t node = domains_.node[k][i];
            const double share = domains_.area[k] * domains_.weight[k][i];
            area[node] += share;
            nodal[node].xx += share * s.xx;
            nodal[node].yy += share * s.yy;
            nodal[node].xy += share * s.xy;
            nodal[node].zz += share * s.zz;
        }
    }
    for (std::size_t i = 0; i < nodal.size(); ++i) {
        nodal[i] = {nodal[i].xx / area[i],
                    nodal[i].yy / area[i],
                    nodal[i].xy / area[i],
                    nodal[i].zz / area[i]};
    }
    return nodal;
}

} // namespace duet::solid
