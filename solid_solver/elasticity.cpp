#include "solid_solver/elasticity.hpp"

#include "solid_solver/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace duet::solid {

namespace {

constexpr std::size_t slots = Domains::slots;
using Gradient = Elasticity::Gradient;

/// E = (g + g^T + g^T g)/2 of g = F - I: xx, yy, xy.
std::array<double, 3> green_strain(const Gradient& g) {
    return {g.xx + 0.5 * (g.xx * g.xx + g.yx * g.yx),
            g.yy + 0.5 * (g.xy * g.xy + g.yy * g.yy),
            0.5 * (g.xy + g.yx + g.xx * g.xy + g.yx * g.yy)};
}

/// The change of E at F = I + g by a change d of F: xx, yy, xy.
std::array<double, 3> strain_change(const Gradient& g, const Gradient& d) {
    return {(1 + g.xx) * d.xx + g.yx * d.yx,
            g.xy * d.xy + (1 + g.yy) * d.yy,
            0.5 * ((1 + g.xx) * d.xy + g.yx * d.yy + g.xy * d.xx + (1 + g.yy) * d.yx)};
}

/// sum_I u_I gradN_I.
Gradient gradient_of(const std::array<std::uint32_t, slots>& node,
                     const std::array<double, slots>& x,
                     const std::array<double, slots>& y,
                     const double* u) {
    Gradient g;
    for (std::size_t s = 0; s < slots; ++s) {
        const double ux = u[2 * node[s]], uy = u[2 * node[s] + 1];
        g.xx += ux * x[s];
        g.xy += ux * y[s];
        g.yx += uy * x[s];
        g.yy += uy * y[s];
    }
    return g;
}

} // namespace

double PlaneTensor::principal(double side) const {
    return 0.5 * (xx + yy) + side * std::hypot(0.5 * (xx - yy), xy);
}

double PlaneTensor::von_mises() const {
    return std::sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx))
                     + 3 * xy * xy);
}

Elasticity::Elasticity(const BodyConfig& body, const Domains& domains)
    : domains_(domains), threads_(body.threads), kinematics_(body.kinematics),
      reference_temperature_(body.reference_temperature), damping_(body.stiffness_damping) {
    bool expands = false;
    for (const Material& m : body.materials()) {
        law_.emplace_back(m, body);
        heated_ = heated_ || (body.thermoelastic_heating && m.beta() * reference_temperature_ != 0);
        expands = expands || m.beta() != 0;
    }
    for (const Point& p : body.mesh.node) {
        reference_.push_back(p.x());
        reference_.push_back(p.y());
    }
    const std::size_t nodes = body.mesh.node.size(), count = domains.size();
    displacement_.assign(2 * nodes, 0.0);
    stress_.assign(3 * count, 0.0);
    latent_.assign(nodes, 0.0);
    if (kinematics_ == Kinematics::updated_lagrangian) {
        out_of_plane_.assign(count, 0.0);
        domain_temperature_.assign(count, reference_temperature_);
        before_.resize(2 * nodes);
    }
    if (expands) {
        trace_.assign(count, 0.0);
        warming_.assign(count, 0.0);
        expansion_work_.assign(count, 0.0);
    }
    damping_stress_.assign(3 * count, 0.0);
    damping_loss_.assign(count, 0.0);
    contribution_.resize(2 * slots * count);
    heat_share_.resize(slots * count);
    heating_.resize(nodes);
    nodal_change_.resize(nodes);
}

void Elasticity::reset(std::span<const double> displacement,
                       std::span<const double> temperature,
                       std::span<double> force) {
    std::fill(displacement_.begin(), displacement_.end(), 0.0);
    std::fill(stress_.begin(), stress_.end(), 0.0);
    std::fill(damping_stress_.begin(), damping_stress_.end(), 0.0);
    std::fill(out_of_plane_.begin(), out_of_plane_.end(), 0.0);
    std::fill(domain_temperature_.begin(), domain_temperature_.end(), reference_temperature_);
    forces(displacement, 0, temperature, force);
    settle(displacement);
}

Gradient Elasticity::gradient(std::size_t k, const double* u) const {
    return gradient_of(domains_.node[k], domains_.gradient_x[k], domains_.gradient_y[k], u);
}

double Elasticity::mean(std::size_t k, const double* nodal) const {
    double sum = 0;
    for (std::size_t s = 0; s < slots; ++s) {
        sum += domains_.weight[k][s] * nodal[domains_.node[k][s]];
    }
    return sum;
}

/// The domain's share of -f_int: -A P gradN_I with P = F S, for each of its nodes (20).
void Elasticity::put_force(std::size_t k, const Gradient& g, double sxx, double syy, double sxy) {
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
void Elasticity::gather(const std::vector<double>& contribution,
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

void Elasticity::forces(std::span<const double> displacement,
                        double dt,
                        std::span<const double> temperature,
                        std::span<double> force) {
    if (kinematics_ == Kinematics::updated_lagrangian) {
        before_.swap(displacement_);
        std::copy(displacement.begin(), displacement.end(), displacement_.begin());
        updated_forces(dt, before_.data(), temperature);
    } else {
        std::copy(displacement.begin(), displacement.end(), displacement_.begin());
        const double per_step = dt > 0 ? damping_ / dt : 0;
        const bool expands = !trace_.empty();
        total_forces(temperature,
                     expands,
                     [&](std::size_t k, const Gradient&, const PlaneTensor& s, double warming) {
                         if (per_step == 0) {
                             return PlaneTensor{};
                         }
                         const double* old = &stress_[3 * k];
                         const double xx = s.xx - old[0], yy = s.yy - old[1], xy = s.xy - old[2];
                         const PlaneTensor d{per_step * xx, per_step * yy, per_step * xy, 0};
                         const double warmer = expands ? warming - warming_[k] : 0;
                         book_damping(k, d, law(k).strain(xx, yy, xy, warmer), domains_.area[k]);
                         return d;
                     });
    }
    gather(contribution_, force.data(), 2);
}

/// P = F (S + b dS/dt); the second part, damping(k, g, S, T - T0), may read the S before.
template <class Damping>
void Elasticity::total_forces(std::span<const double> temperature,
                              bool book,
                              const Damping& damping) {
    in_pieces(domains_.size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Gradient g = gradient(k, displacement_.data());
            const auto e = green_strain(g);
            const double warming = mean(k, temperature.data()) - reference_temperature_;
            const PlaneTensor s = law(k).stress(e[0], e[1], e[2], warming);
            const PlaneTensor d = damping(k, g, s, warming);
            put_force(k, g, s.xx + d.xx, s.yy + d.yy, s.xy + d.xy);
            stress_[3 * k] = s.xx;
            stress_[3 * k + 1] = s.yy;
            stress_[3 * k + 2] = s.xy;
            if (book) {
                book_expansion(k, e[0] + e[1] - trace_[k], warming, domains_.area[k]);
                trace_[k] = e[0] + e[1];
            }
        }
    });
}

/// beta (T - T0) d tr(E), by the trapezoidal rule from one step to the next.
void Elasticity::book_expansion(std::size_t k, double trace, double warming, double measure) {
    expansion_work_[k] += 0.5 * (warming_[k] + warming) * law(k).beta * measure * trace;
    warming_[k] = warming;
}

/// The damping stress of the step before did its work in the first half of this one, the new one
/// does in the second.
void Elasticity::book_damping(std::size_t k,
                              const PlaneTensor& stress,
                              const std::array<double, 3>& strain,
                              double measure) {
    double* old = &damping_stress_[3 * k];
    damping_loss_[k] += 0.5 * measure
                        * ((old[0] + stress.xx) * strain[0] + (old[1] + stress.yy) * strain[1]
                           + 2 * (old[2] + stress.xy) * strain[2]);
    old[0] = stress.xx;
    old[1] = stress.yy;
    old[2] = stress.xy;
}

void Elasticity::settle(std::span<const double> displacement) {
    latent_heat(displacement, latent_);
    std::fill(expansion_work_.begin(), expansion_work_.end(), 0.0);
    std::fill(damping_loss_.begin(), damping_loss_.end(), 0.0);
}

double Elasticity::damping_loss() const {
    return std::accumulate(damping_loss_.begin(), damping_loss_.end(), 0.0);
}

double Elasticity::expansion_work() const {
    return std::accumulate(expansion_work_.begin(), expansion_work_.end(), 0.0);
}

void Elasticity::evaluate(std::span<const double> displacement,
                          std::span<const double> velocity,
                          std::span<const double> temperature,
                          std::span<const double> warming,
                          std::span<double> force) {
    std::copy(displacement.begin(), displacement.end(), displacement_.begin());
    total_forces(
        temperature, false, [&](std::size_t k, const Gradient& g, const PlaneTensor&, double) {
            if (damping_ == 0) {
                return PlaneTensor{};
            }
            const auto d = strain_change(g, gradient(k, velocity.data()));
            const PlaneTensor rate = law(k).stress(d[0], d[1], d[2], mean(k, warming.data()));
            return PlaneTensor{damping_ * rate.xx, damping_ * rate.yy, damping_ * rate.xy, 0};
        });
    gather(contribution_, force.data(), 2);
}

void Elasticity::accept(std::span<const double> displacement, std::span<const double> temperature) {
    latent_heat(displacement, latent_);
    for (std::size_t k = 0; k < trace_.size(); ++k) {
        const auto e = green_strain(gradient(k, displacement.data()));
        const double warming = mean(k, temperature.data()) - reference_temperature_;
        book_expansion(k, e[0] + e[1] - trace_[k], warming, domains_.area[k]);
        trace_[k] = e[0] + e[1];
    }
}

std::span<const double> Elasticity::heating(std::span<const double> displacement, double dt) {
    if (!heated_) {
        return {};
    }
    if (kinematics_ == Kinematics::total_lagrangian) {
        latent_heat(displacement, heating_);
        for (std::size_t i = 0; i < latent_.size(); ++i) {
            const double before = latent_[i];
            latent_[i] = heating_[i];
            heating_[i] = (before - latent_[i]) / dt;
        }
        return heating_;
    }
    in_pieces(domains_.size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Shape middle = middle_shape(k, displacement_.data(), displacement.data());
            const Gradient l = increment(k, middle, displacement_.data(), displacement.data());
            const double heat =
                -law(k).beta * reference_temperature_ * middle.area * (l.xx + l.yy) / dt;
            for (std::size_t s = 0; s < slots; ++s) {
                heat_share_[slots * k + s] = heat * domains_.weight[k][s];
            }
        }
    });
    gather(heat_share_, heating_.data(), 1);
    return heating_;
}

void Elasticity::latent_heat(std::span<const double> displacement, std::span<double> nodal) {
    if (!heated_) {
        std::fill(nodal.begin(), nodal.end(), 0.0);
        return;
    }
    in_pieces(domains_.size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto e = green_strain(gradient(k, displacement.data()));
            const double heat =
                law(k).beta * reference_temperature_ * domains_.area[k] * (e[0] + e[1]);
            for (std::size_t s = 0; s < slots; ++s) {
                heat_share_[slots * k + s] = heat * domains_.weight[k][s];
            }
        }
    });
    gather(heat_share_, nodal.data(), 1);
}

Elasticity::Linearised Elasticity::linearised(std::size_t k) const {
    const Law& m = law(k);
    const double warming = heated_ ? m.beta * m.beta * reference_temperature_ / m.heat_capacity : 0;
    const PlaneTensor stress{stress_[3 * k], stress_[3 * k + 1], stress_[3 * k + 2], 0};
    if (kinematics_ == Kinematics::updated_lagrangian) {
        return {present_shape(k, displacement_.data()), {}, stress, m.lambda, m.mu, warming};
    }
    return {{domains_.area[k], domains_.gradient_x[k], domains_.gradient_y[k]},
            gradient(k, displacement_.data()),
            stress,
            m.lambda,
            m.mu,
            warming};
}

void Elasticity::apply_tangent(std::span<const double> u,
                               std::span<double> force,
                               double material,
                               const Warming& warming) {
    if (heated_) {
        for (std::size_t k = 0; k < domains_.size(); ++k) {
            const Linearised l = linearised(k);
            const auto e =
                strain_change(l.g, gradient_of(domains_.node[k], l.shape.x, l.shape.y, u.data()));
            const double heat =
                -law(k).beta * reference_temperature_ * l.shape.area * (e[0] + e[1]);
            for (std::size_t s = 0; s < slots; ++s) {
                heat_share_[slots * k + s] = heat * domains_.weight[k][s];
            }
        }
        gather(heat_share_, nodal_change_.data(), 1);
        warming(nodal_change_);
    }
    for (std::size_t k = 0; k < domains_.size(); ++k) {
        const Linearised l = linearised(k);
        const Gradient d = gradient_of(domains_.node[k], l.shape.x, l.shape.y, u.data());
        const auto e = strain_change(l.g, d);
        const double warmer = heated_ ? mean(k, nodal_change_.data()) : 0;
        const double level = material * l.lambda * (e[0] + e[1]) - law(k).beta * warmer;
        const double twice = 2 * material * l.mu;
        const double sxx = level + twice * e[0], syy = level + twice * e[1], sxy = twice * e[2];
        // F dS, and dF S: the stress that is there already, turned with the material.
        const double fxx = 1 + l.g.xx, fyy = 1 + l.g.yy;
        const PlaneTensor& s = l.stress;
        const double pxx = fxx * sxx + l.g.xy * sxy + d.xx * s.xx + d.xy * s.xy;
        const double pxy = fxx * sxy + l.g.xy * syy + d.xx * s.xy + d.xy * s.yy;
        const double pyx = l.g.yx * sxx + fyy * sxy + d.yx * s.xx + d.yy * s.xy;
        const double pyy = l.g.yx * sxy + fyy * syy + d.yx * s.xy + d.yy * s.yy;
        double* out = &contribution_[2 * slots * k];
        for (std::size_t i = 0; i < slots; ++i) {
            out[2 * i] = l.shape.area * (pxx * l.shape.x[i] + pxy * l.shape.y[i]);
            out[2 * i + 1] = l.shape.area * (pyx * l.shape.x[i] + pyy * l.shape.y[i]);
        }
    }
    gather(contribution_, force.data(), 2);
}

double Elasticity::strain_energy() const {
    double energy = 0;
    for (std::size_t k = 0; k < domains_.size(); ++k) {
        const Law& m = law(k);
        if (kinematics_ == Kinematics::total_lagrangian) {
            const auto e = green_strain(gradient(k, displacement_.data()));
            energy += domains_.area[k] * m.energy(e[0], e[1], e[2]);
        } else { // the strain that the stress stands for
            const double* s = &stress_[3 * k];
            const double thermal = m.beta * (domain_temperature_[k] - reference_temperature_);
            const double trace = 0.5 * (s[0] + s[1] + 2 * thermal) / (m.lambda + m.mu);
            const double level = m.lambda * trace - thermal;
            energy += present_shape(k, displacement_.data()).area
                      * m.energy((s[0] - level) / (2 * m.mu),
                                 (s[1] - level) / (2 * m.mu),
                                 s[2] / (2 * m.mu));
        }
    }
    return energy;
}

/// sigma = F S F^T / J; F is 1 out of the plane, or sqrt(1 + 2 E_zz) in plane stress.
PlaneTensor Elasticity::domain_stress(std::size_t k, std::span<const double> temperature) const {
    if (kinematics_ == Kinematics::updated_lagrangian) {
        const double zz = law(k).plane_stress ? 0 : out_of_plane_[k];
        return {stress_[3 * k], stress_[3 * k + 1], stress_[3 * k + 2], zz};
    }
    const Gradient g = gradient(k, displacement_.data());
    const auto e = green_strain(g);
    const double warming = mean(k, temperature.data()) - reference_temperature_;
    const PlaneTensor s = law(k).stress(e[0], e[1], e[2], warming);
    const double fxx = 1 + g.xx, fyy = 1 + g.yy;
    const double jacobian =
        (fxx * fyy - g.xy * g.yx) * std::sqrt(1 + 2 * law(k).thickening(e[0] + e[1], warming));
    const double pxx = fxx * s.xx + g.xy * s.xy, pxy = fxx * s.xy + g.xy * s.yy;
    const double pyx = g.yx * s.xx + fyy * s.xy, pyy = g.yx * s.xy + fyy * s.yy;
    return {(pxx * fxx + pxy * g.xy) / jacobian,
            (pyx * g.yx + pyy * fyy) / jacobian,
            (pxx * g.yx + pxy * fyy) / jacobian,
            s.zz / jacobian};
}

template <class OfDomain>
std::vector<PlaneTensor> Elasticity::nodal_mean(const OfDomain& of_domain) const {
    std::vector<PlaneTensor> nodal(latent_.size());
    std::vector<double> area(latent_.size(), 0.0);
    for (std::size_t k = 0; k < domains_.size(); ++k) {
        const PlaneTensor s = of_domain(k);
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

std::vector<PlaneTensor> Elasticity::nodal_stress(std::span<const double> temperature) const {
    return nodal_mean([&](std::size_t k) { return domain_stress(k, temperature); });
}

std::vector<PlaneTensor> Elasticity::nodal_strain() const {
    return nodal_mean([&](std::size_t k) {
        const auto e = green_strain(gradient(k, displacement_.data()));
        return PlaneTensor{e[0], e[1], e[2], 0};
    });
}

} // namespace duet::solid
