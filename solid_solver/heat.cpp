#include "solid_solver/heat.hpp"

#include "solid_solver/parallel.hpp"
#include "solid_solver/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace duet::solid {

Heat::Heat(const BodyConfig& body, const Domains& domains)
    : threads_(body.threads), conduction_(domains, body.material.conductivity) {
    const std::vector<double> area = nodal_area(body.mesh);
    const std::size_t nodes = area.size();
    capacity_.resize(nodes);
    constant_.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        capacity_[i] = body.material.density * body.material.heat_capacity * area[i]; // (25)
        constant_[i] = body.heat_source * area[i];                                    // (28)
        source_power_ += constant_[i];
    }
    interface_.assign(nodes, 0.0);
    temperature_.assign(nodes, body.initial_temperature);
    apply_boundary(body);
    start_ = temperature_;
    next_.resize(nodes);
    factor_.resize(nodes);
    collect_load();
    stable_step_ = bound();
}

void Heat::apply_boundary(const BodyConfig& body) {
    const std::vector<Edge> boundary = boundary_edges(body.mesh);
    std::vector<double> exchange(temperature_.size(), 0.0), ambient(temperature_.size(), 0.0);
    std::vector<double> held(temperature_.size(), std::nan(""));
    for (const BoundaryCondition& condition : body.boundary) {
        for (const Edge& edge : edges_of(condition, body, boundary)) {
            const double half = 0.5 * (body.mesh.node[edge.b] - body.mesh.node[edge.a]).norm();
            for (const std::uint32_t i : {edge.a, edge.b}) {
                constant_[i] += condition.heat_flux * half; // (29)
                flux_power_ += condition.heat_flux * half;
                if (condition.convection) { // (26), (30), lumped like the capacity
                    exchange[i] += condition.convection->coefficient * half;
                    ambient[i] += condition.convection->coefficient * half
                                  * condition.convection->temperature;
                }
                if (condition.temperature) {
                    held[i] = *condition.temperature;
                }
            }
        }
    }
    for (std::uint32_t i = 0; i < temperature_.size(); ++i) {
        if (exchange[i] > 0) {
            exchange_.push_back({i, exchange[i], ambient[i] / exchange[i]});
        }
        if (!std::isnan(held[i])) {
            fixed_.push_back({i, held[i]});
            temperature_[i] = held[i];
        }
    }
}

void Heat::collect_load() {
    load_.resize(constant_.size());
    for (std::size_t i = 0; i < load_.size(); ++i) {
        load_[i] = constant_[i] + interface_[i];
    }
    interface_power_ = std::accumulate(interface_.begin(), interface_.end(), 0.0);
}

void Heat::set_interface_heat(std::span<const double> nodal) {
    interface_.assign(nodal.begin(), nodal.end());
    collect_load();
}

void Heat::set_temperature(std::span<const double> temperature) {
    temperature_.assign(temperature.begin(), temperature.end());
    for (const Fixed& fixed : fixed_) {
        temperature_[fixed.node] = fixed.temperature;
    }
    start_ = temperature_;
    account_ = {};
}

void Heat::step(double dt, std::span<const double> thermoelastic) {
    if (dt != factor_dt_) {
        for (std::size_t i = 0; i < factor_.size(); ++i) {
            factor_[i] = dt / capacity_[i];
        }
        factor_dt_ = dt;
    }
    const double* rate = load_.data();
    if (!exchange_.empty() || !thermoelastic.empty()) {
        rate_ = load_;
        for (std::size_t i = 0; i < thermoelastic.size(); ++i) {
            rate_[i] += thermoelastic[i];
            account_.thermoelastic += dt * thermoelastic[i];
        }
        for (const Exchange& exchange : exchange_) {
            const double power =
                exchange.coefficient * (exchange.temperature - temperature_[exchange.node]);
            rate_[exchange.node] += power;
            account_.walls += dt * power;
        }
        rate = rate_.data();
    }
    in_pieces(temperature_.size(), threads_, [&](std::size_t begin, std::size_t end) {
        conduction_.advance(temperature_.data(), rate, factor_.data(), next_.data(), begin, end);
    });
    temperature_.swap(next_);
    account_.interface += dt * interface_power_;
    account_.walls += dt * flux_power_;
    account_.sources += dt * source_power_;
    hold();
}

/// Prescribed temperatures: what must come in there to keep them.
void Heat::hold() {
    for (const Fixed& fixed : fixed_) {
        account_.walls += capacity_[fixed.node] * (fixed.temperature - temperature_[fixed.node]);
        temperature_[fixed.node] = fixed.temperature;
    }
}

void Heat::flow(std::span<const double> temperature, std::span<double> out) const {
    conduction_.flow(temperature.data(), out.data());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] += load_[i];
    }
    for (const Exchange& exchange : exchange_) {
        out[exchange.node] +=
            exchange.coefficient * (exchange.temperature - temperature[exchange.node]);
    }
}

void Heat::book(double length, std::span<const double> temperature) {
    account_.interface += length * interface_power_;
    account_.walls += length * flux_power_;
    account_.sources += length * source_power_;
    for (const Exchange& exchange : exchange_) {
        account_.walls +=
            length * exchange.coefficient * (exchange.temperature - temperature[exchange.node]);
    }
}

void Heat::take(std::span<const double> heat, std::span<const double> thermoelastic) {
    for (std::size_t i = 0; i < temperature_.size(); ++i) {
        temperature_[i] += (heat[i] + thermoelastic[i]) / capacity_[i];
        account_.thermoelastic += thermoelastic[i];
    }
    hold();
}

double Heat::stored() const {
    double heat = 0;
    for (std::size_t i = 0; i < temperature_.size(); ++i) {
        heat += capacity_[i] * (temperature_[i] - start_[i]);
    }
    return heat;
}

double Heat::mean_temperature() const {
    double heat = 0, capacity = 0;
    for (std::size_t i = 0; i < temperature_.size(); ++i) {
        heat += capacity_[i] * temperature_[i];
        capacity += capacity_[i];
    }
    return heat / capacity;
}

double Heat::bound() const {
    const std::vector<double> none(capacity_.size(), 0.0), minus(capacity_.size(), -1.0);
    Spectrum spectrum(capacity_.size());
    const auto stiffness = [&](const double* x, double* y) {
        conduction_.advance(x, none.data(), minus.data(), y, 0, capacity_.size()); // x + K x
        for (std::size_t i = 0; i < capacity_.size(); ++i) {
            y[i] -= x[i];
        }
        for (const Exchange& exchange : exchange_) {
            y[exchange.node] += exchange.coefficient * x[exchange.node];
        }
    };
    std::vector<double> inverse(capacity_.size());
    std::transform(
        capacity_.begin(), capacity_.end(), inverse.begin(), [](double c) { return 1 / c; });
    const double largest = spectrum.largest(stiffness, inverse);
    return largest > 0 ? 2 / largest : 0;
}

} // namespace duet::solid
