#include "solid_solver/body_config.hpp"

#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace duet::solid {

namespace {

/// The boundary edges that belong to the mesh's curve of that name.
std::vector<Edge> edges_of_curve(const BoundaryCondition& condition,
                                 const BodyConfig& body,
                                 const std::vector<Edge>& boundary) {
    using Pair = std::pair<std::uint32_t, std::uint32_t>;
    std::set<Pair> wanted;
    std::string names;
    for (const Curve& curve : body.mesh.curve) {
        names += (names.empty() ? "" : ", ") + curve.name;
        if (curve.name != condition.curve) {
            continue;
        }
        for (const auto& [a, b] : curve.edge) {
            wanted.insert(std::minmax(a, b));
        }
    }
    std::vector<Edge> chosen;
    for (const Edge& edge : boundary) {
        if (wanted.count(std::minmax(edge.a, edge.b)) > 0) {
            chosen.push_back(edge);
        }
    }
    if (chosen.empty()) {
        throw std::invalid_argument("Boundary '" + condition.name + "' of body '" + body.name
                                    + "' names the curve '" + condition.curve
                                    + "', on which no boundary edge of its mesh lies; its curves "
                                    + (names.empty() ? "have no names." : "are " + names + "."));
    }
    return chosen;
}

} // namespace

std::vector<Edge> edges_of(const BoundaryCondition& condition,
                           const BodyConfig& body,
                           const std::vector<Edge>& boundary) {
    if (!condition.curve.empty()) {
        return edges_of_curve(condition, body, boundary);
    }
    const Point line = condition.to - condition.from;
    const double length = line.norm();
    const double tolerance = 1e-6; // of the line or of the edge, whichever is shorter
    const auto on_line = [&](const Point& p, double slack) {
        const Point d = p - condition.from;
        const double off = (d.x() * line.y() - d.y() * line.x()) / length;
        const double along = d.dot(line) / length;
        return std::abs(off) <= slack && along >= -slack && along <= length + slack;
    };
    std::vector<Edge> chosen;
    for (const Edge& edge : boundary) {
        const Point &a = body.mesh.node[edge.a], &b = body.mesh.node[edge.b];
        const double slack = tolerance * std::min(length, (b - a).norm());
        if (length > 0 && on_line(a, slack) && on_line(b, slack)) {
            chosen.push_back(edge);
        }
    }
    if (chosen.empty()) {
        std::ostringstream sentence;
        sentence << "Boundary '" << condition.name << "' of body '" << body.name
                 << "' matches no edge: no side of the body lies on the line from ("
                 << condition.from.x() << ", " << condition.from.y() << ") to (" << condition.to.x()
                 << ", " << condition.to.y() << ").";
        throw std::invalid_argument(sentence.str());
    }
    return chosen;
}

double volumetric_capacity(const Material& material, const BodyConfig& body) {
    const double capacity = material.density * material.heat_capacity;
    if (body.plane == Plane::strain || body.motion != Motion::deformable
        || !body.thermoelastic_heating) {
        return capacity;
    }
    const double beta = material.beta(), modulus = material.lambda() + 2 * material.mu();
    return capacity + body.reference_temperature * beta * beta / modulus;
}

} // namespace duet::solid
