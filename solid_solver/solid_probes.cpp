#include "solid_solver/solid_probes.hpp"

#include "protocol/probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace duet::solid {

namespace {

/// Stress and strain of a body's nodes.
struct Nodal {
    std::vector<PlaneTensor> stress, strain;
};

struct Quantity {
    const char* name;
    bool odd;       ///< changes sign in a vertical mirror
    bool of_stress; ///< a fixed body has none
    double (*value)(const Body&, const Nodal&, std::uint32_t node);
};

double displacement(const Body& body, std::uint32_t node, Eigen::Index d) {
    return body.position()[2 * node + static_cast<std::size_t>(d)]
           - body.config().mesh.node[node][d];
}

constexpr Quantity fields[] = {
    {"temperature",
     false,
     false,
     [](const Body& b, const Nodal&, std::uint32_t i) { return b.temperature()[i]; }},
    {"displacement_x",
     true,
     false,
     [](const Body& b, const Nodal&, std::uint32_t i) { return displacement(b, i, 0); }},
    {"displacement_y",
     false,
     false,
     [](const Body& b, const Nodal&, std::uint32_t i) { return displacement(b, i, 1); }},
    {"velocity_x",
     true,
     false,
     [](const Body& b, const Nodal&, std::uint32_t i) { return b.velocity()[2 * i]; }},
    {"velocity_y",
     false,
     false,
     [](const Body& b, const Nodal&, std::uint32_t i) { return b.velocity()[2 * i + 1]; }},
    {"stress_xx",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.stress[i].xx; }},
    {"stress_yy",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.stress[i].yy; }},
    {"stress_xy",
     true,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.stress[i].xy; }},
    {"stress_zz",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.stress[i].zz; }},
    {"von_mises",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.stress[i].von_mises(); }},
    {"principal_stress_1",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.stress[i].principal(+1); }},
    {"principal_stress_2",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.stress[i].principal(-1); }},
    {"strain_xx",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.strain[i].xx; }},
    {"strain_yy",
     false,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.strain[i].yy; }},
    {"strain_xy",
     true,
     true,
     [](const Body&, const Nodal& s, std::uint32_t i) { return s.strain[i].xy; }},
};

/// How the bodies' values make one.
enum class Join { sum, mean_by_capacity, largest, smallest };

struct Integral {
    const char* name;
    Join join;
    double (*value)(const Body&);
};

double extreme(const Body& body, bool largest) {
    const auto t = body.temperature();
    return largest ? *std::max_element(t.begin(), t.end()) : *std::min_element(t.begin(), t.end());
}

/// What holds a body's held nodes, d = 0: along x, 1: along y.
double reaction(const Body& body, std::size_t d) {
    double sum = 0;
    if (body.mechanics()) {
        const std::vector<double> force = body.mechanics()->reaction();
        for (std::size_t c = d; c < force.size(); c += 2) {
            sum += force[c];
        }
    }
    return sum;
}

constexpr Integral integrals[] = {
    {"mean_temperature",
     Join::mean_by_capacity,
     [](const Body& b) { return b.heat().mean_temperature(); }},
    {"max_temperature", Join::largest, [](const Body& b) { return extreme(b, true); }},
    {"min_temperature", Join::smallest, [](const Body& b) { return extreme(b, false); }},
    {"heat", Join::sum, [](const Body& b) { return b.heat().stored(); }},
    {"heat_received", Join::sum, [](const Body& b) { return b.heat().account().interface; }},
    {"kinetic_energy", Join::sum, [](const Body& b) { return b.kinetic_energy(); }},
    {"strain_energy", Join::sum, [](const Body& b) { return b.strain_energy(); }},
    {"angle", Join::sum, [](const Body& b) { return b.rigid() ? b.rigid()->angle() : 0.0; }},
    {"work_of_interface", Join::sum, [](const Body& b) { return b.energy().interface; }},
    {"work_of_loads", Join::sum, [](const Body& b) { return b.energy().loads; }},
    {"work_of_supports", Join::sum, [](const Body& b) { return b.energy().supports; }},
    {"work_of_expansion", Join::sum, [](const Body& b) { return b.energy().expansion; }},
    {"dissipated", Join::sum, [](const Body& b) { return b.energy().dissipated; }},
    {"energy_residual", Join::sum, [](const Body& b) { return b.energy().residual(); }},
    {"reaction_x", Join::sum, [](const Body& b) { return reaction(b, 0); }},
    {"reaction_y", Join::sum, [](const Body& b) { return reaction(b, 1); }},
    {"area", Join::sum, [](const Body& b) { return b.area(); }},
};

/// Over a named boundary of a body.
struct BoundaryQuantity {
    const char* name;
    double (*value)(const Body&, std::size_t condition);
};

constexpr BoundaryQuantity boundary_quantities[] = {
    {"reaction_x",
     [](const Body& b, std::size_t c) {
         return b.mechanics() ? b.mechanics()->reaction_on(c).x() : 0.0;
     }},
    {"reaction_y",
     [](const Body& b, std::size_t c) {
         return b.mechanics() ? b.mechanics()->reaction_on(c).y() : 0.0;
     }},
    {"heat_flow", [](const Body& b, std::size_t c) { return b.heat().power_through(c); }},
};

/// The conditions of that name, of all bodies that the probe may mean.
double over_boundary(const BoundaryQuantity& quantity,
                     const v1::Probe& probe,
                     const Solid& solid,
                     const std::vector<std::size_t>& bodies) {
    double sum = 0;
    bool found = false;
    for (const std::size_t b : bodies) {
        const std::vector<BoundaryCondition>& conditions = solid.bodies()[b].config().boundary;
        for (std::size_t c = 0; c < conditions.size(); ++c) {
            if (conditions[c].name == probe.boundary()) {
                sum += quantity.value(solid.bodies()[b], c);
                found = true;
            }
        }
    }
    if (!found) {
        throw std::invalid_argument("Probe \"" + probe.name() + "\" names the boundary \""
                                    + probe.boundary() + "\", which no body has.");
    }
    return sum;
}

template <class Table>
const auto& known(const Table& table, const v1::Probe& probe, const std::string& kind) {
    std::string names;
    for (const auto& row : table) {
        if (probe.quantity() == row.name) {
            return row;
        }
        names += (names.empty() ? "" : ", ") + std::string(row.name);
    }
    throw std::invalid_argument("Probe \"" + probe.name() + "\": the solid has no quantity \""
                                + probe.quantity() + "\" " + kind + "; it knows " + names + ".");
}

std::vector<std::size_t> bodies_of(const v1::Probe& probe, const Solid& solid) {
    std::vector<std::size_t> chosen;
    std::string names;
    for (std::size_t b = 0; b < solid.bodies().size(); ++b) {
        const std::string& name = solid.bodies()[b].config().name;
        if (probe.body().empty() || probe.body() == name) {
            chosen.push_back(b);
        }
        names += (names.empty() ? "" : ", ") + name;
    }
    if (chosen.empty()) {
        throw std::invalid_argument(
            "Probe \"" + probe.name() + "\" names the body \"" + probe.body()
            + "\", which the scene does not have; its bodies are " + names + ".");
    }
    return chosen;
}

double capacity(const Body& body) {
    const auto nodal = body.heat().capacity();
    return std::accumulate(nodal.begin(), nodal.end(), 0.0);
}

double
joined(const Integral& integral, const Solid& solid, const std::vector<std::size_t>& bodies) {
    double sum = 0, weight = 0;
    double largest = -std::numeric_limits<double>::infinity(), smallest = -largest;
    for (const std::size_t b : bodies) {
        const Body& body = solid.bodies()[b];
        const double value = integral.value(body);
        const double share = integral.join == Join::mean_by_capacity ? capacity(body) : 1;
        sum += share * value;
        weight += share;
        largest = std::max(largest, value);
        smallest = std::min(smallest, value);
    }
    switch (integral.join) {
    case Join::mean_by_capacity:
        return sum / weight;
    case Join::largest:
        return largest;
    case Join::smallest:
        return smallest;
    default:
        return sum;
    }
}

} // namespace

Probes::Probes(const v1::Scene& scene, const Solid& solid) {
    for (const v1::Probe& probe : scene.probe()) {
        if (probe.of() != v1::Probe::SOLID) {
            continue;
        }
        Prepared prepared{probe, {}, bodies_of(probe, solid)};
        if (!probe.boundary().empty()) {
            over_boundary(
                known(boundary_quantities, probe, "on a boundary"), probe, solid, prepared.bodies);
            prepared_.push_back(std::move(prepared));
            continue;
        }
        if (!protocol::is_field_probe(probe)) {
            known(integrals, probe, "over a body");
            prepared_.push_back(std::move(prepared));
            continue;
        }
        const Quantity& field = known(fields, probe, "at points");
        bool found = false;
        for (const v1::Vector& point : protocol::probe_points(probe)) {
            std::optional<Place> place;
            for (const std::size_t b : prepared.bodies) {
                const Body& body = solid.bodies()[b];
                if (place || (field.of_stress && !body.deformable())) {
                    continue;
                }
                if (const auto at = interpolation_at(body.config().mesh, {point.x(), point.y()})) {
                    place = Place{b, *at};
                }
            }
            found = found || place;
            prepared.points.push_back(place);
        }
        if (!found) {
            throw std::invalid_argument(
                "Probe \"" + probe.name() + "\" lies outside every "
                + (field.of_stress ? "deformable body; a fixed one has no stress."
                                   : "body; give material points of the undeformed solid."));
        }
        prepared_.push_back(std::move(prepared));
    }
}

void Probes::take(const Solid& solid,
                  double time,
                  google::protobuf::RepeatedPtrField<v1::Sample>& samples) const {
    std::vector<Nodal> tensors(solid.bodies().size()); // made when the first probe asks for it
    for (const Prepared& prepared : prepared_) {
        const v1::Probe& probe = prepared.probe;
        if (!probe.boundary().empty()) {
            const BoundaryQuantity& quantity = known(boundary_quantities, probe, "on a boundary");
            *samples.Add() = protocol::integral_sample(
                probe, time, over_boundary(quantity, probe, solid, prepared.bodies));
            continue;
        }
        if (prepared.points.empty()) {
            const Integral& integral = known(integrals, probe, "over a body");
            *samples.Add() =
                protocol::integral_sample(probe, time, joined(integral, solid, prepared.bodies));
            continue;
        }
        const Quantity& field = known(fields, probe, "at points");
        std::vector<double> values;
        for (const std::optional<Place>& place : prepared.points) {
            if (!place) {
                values.push_back(std::nan(""));
                continue;
            }
            const Body& body = solid.bodies()[place->body];
            Nodal& nodal = tensors[place->body];
            if (field.of_stress && nodal.stress.empty()) {
                nodal.stress = body.mechanics()->nodal_stress(body.temperature());
                nodal.strain = body.mechanics()->elasticity().nodal_strain();
            }
            double value = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                value += place->at.weight[i] * field.value(body, nodal, place->at.node[i]);
            }
            values.push_back(value);
        }
        *samples.Add() = protocol::field_sample(probe, time, values, field.odd);
    }
}

} // namespace duet::solid
