#include "solid_solver/heat.hpp"

#include "solid_solver/parallel.hpp"
#include "solid_solver/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace duet::solid {

namespace {

std::vector<double> conductivities(const BodyConfig& body) {
    std::vector<double> all;
    for (const Material& material : body.materials()) {
        all.push_back(material.conductivity);
    }
    return all;
}

} // namespace

Heat::Heat(const BodyConfig& body, const Domains& domains)
    : threads_(body.threads), conduction_(domains, conductivities(body)), place_(body.mesh.node) {
    std::vector<double> density;
    for (const Material& material : body.materials()) {
        density.push_back(volumetric_capacity(material, body));
    }
    capacity_ = nodal_area(body.mesh, density); // (25)
    const std::vector<double> area = nodal_area(body.mesh);
    const std::size_t nodes = area.size();
    constant_.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        source_.push_back(body.heat_source * area[i]); // (28)
        source_power_ += source_[i];
        temperature_.push_back(body.initial_temperature(place_[i], 0));
    }
    interface_.assign(nodes, 0.0);
    apply_boundary(body);
    for (const Fixed& fixed : fixed_) {
        temperature_[fixed.node] = fixed.temperature;
    }
    start_ = temperature_;
    next_.resize(nodes);
    factor_.resize(nodes);
    stable_step_ = bound();
}

void Heat::apply_boundary(const BodyConfig& body) {
    const std::vector<Edge> boundary = boundary_edges(body.mesh);
    std::vector<double> exchange(temperature_.size(), 0.0);
    std::map<std::uint32_t, Fixed> held;
    for (std::size_t c = 0; c < body.boundary.size(); ++c) {
        const BoundaryCondition& condition = body.boundary[c];
        varies_ = varies_ || !condition.heat_flux.steady()
                  || (condition.temperature && !condition.temperature->steady())
                  || (condition.convection && !condition.convection->temperature.steady());
        for (const Edge& edge : edges_of(condition, body, boundary)) {
            const double half = 0.5 * (place_[edge.b] - place_[edge.a]).norm();
            if (!condition.heat_flux.zero()) {
                flux_.push_back({edge.a, edge.b, c, half, condition.heat_flux}); // (29)
            }
            if (condition.convection) { // (26), (30), lumped like the capacity
                const double coefficient = condition.convection->coefficient * half;
                surroundings_.push_back(
                    {edge.a, edge.b, c, coefficient, condition.convection->temperature});
                exchange[edge.a] += coefficient;
                exchange[edge.b] += coefficient;
            }
            if (condition.temperature) {
                for (const std::uint32_t node : {edge.a, edge.b}) {
                    held.insert_or_assign(node, Fixed{node, c, *condition.temperature});
                }
            }
        }
    }
    for (std::uint32_t i = 0; i < exchange.size(); ++i) {
        if (exchange[i] > 0) {
            exchange_.push_back({i, exchange[i], 0});
        }
    }
    for (const auto& [node, fixed] : held) {
        fixed_.push_back(fixed);
    }
    ambient_.resize(surroundings_.empty() ? 0 : temperature_.size());
    set_boundary(0, 0);
}

/// A field that is linear along the edge, against the shape functions of its two nodes.
std::array<double, 2> Heat::on_nodes(const OnEdge& edge, double time) const {
    const double a = edge.field(place_[edge.a], time), b = edge.field(place_[edge.b], time);
    return {edge.half * (2 * a + b) / 3, edge.half * (a + 2 * b) / 3};
}

void Heat::set_boundary(double middle, double end) {
    constant_ = source_;
    flux_power_ = 0;
    for (const OnEdge& edge : flux_) {
        const auto [a, b] = on_nodes(edge, middle);
        constant_[edge.a] += a;
        constant_[edge.b] += b;
        flux_power_ += a + b;
    }
    middle_ = middle;
    std::fill(ambient_.begin(), ambient_.end(), 0.0);
    for (const OnEdge& edge : surroundings_) { // lumped, as its coefficient is
        ambient_[edge.a] += edge.half * edge.field(place_[edge.a], middle);
        ambient_[edge.b] += edge.half * edge.field(place_[edge.b], middle);
    }
    for (Exchange& exchange : exchange_) {
        exchange.temperature = ambient_[exchange.node] / exchange.coefficient;
    }
    for (Fixed& fixed : fixed_) {
        fixed.temperature = fixed.field(place_[fixed.node], end);
    }
    collect_load();
}

void Heat::set_time(double begin, double end) {
    if (varies_) {
        set_boundary(0.5 * (begin + end), end);
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
    hold(dt);
}

/// Prescribed temperatures: what must come in there to keep them.
void Heat::hold(double length) {
    for (Fixed& fixed : fixed_) {
        const double heat = capacity_[fixed.node] * (fixed.temperature - temperature_[fixed.node]);
        account_.walls += heat;
        fixed.power = heat / length;
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

double Heat::power_through(std::size_t condition) const {
    double power = 0;
    for (const OnEdge& edge : flux_) {
        if (edge.condition == condition) {
            const auto [a, b] = on_nodes(edge, middle_);
            power += a + b;
        }
    }
    for (const OnEdge& edge : surroundings_) {
        for (const std::uint32_t node : {edge.a, edge.b}) {
            if (edge.condition == condition) {
                power += edge.half * (edge.field(place_[node], middle_) - temperature_[node]);
            }
        }
    }
    for (const Fixed& fixed : fixed_) {
        power += fixed.condition == condition ? fixed.power : 0;
    }
    return power;
}

void Heat::take(double length,
                std::span<const double> heat,
                std::span<const double> thermoelastic) {
    for (std::size_t i = 0; i < temperature_.size(); ++i) {
        temperature_[i] += (heat[i] + thermoelastic[i]) / capacity_[i];
        account_.thermoelastic += thermoelastic[i];
    }
    hold(length);
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
    const auto stiffness = [&](std::span<const double> x, std::span<double> y) {
        conduction_.advance(
            x.data(), none.data(), minus.data(), y.data(), 0, capacity_.size()); // x + K x
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
