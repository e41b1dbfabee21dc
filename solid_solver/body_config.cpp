#include "solid_solver/body_config.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace duet::solid {

std::vector<Edge> edges_of(const BoundaryCondition& condition,
                           const BodyConfig& body,
                           const std::vector<Edge>& boundary) {
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

} // namespace duet::solid
