#include "solid_solver/loads.hpp"

#include "solid_solver/locator.hpp"

#include <algorithm>
#include <stdexcept>

namespace duet::solid {

Loads::Loads(const BodyConfig& body, std::span<const double> mass) : place_(body.mesh.node) {
    for (const double m : mass) {
        body_force_.insert(body_force_.end(), {m * body.body_force.x(), m * body.body_force.y()});
    }
    const std::vector<Edge> boundary = boundary_edges(body.mesh);
    for (std::size_t index = 0; index < body.boundary.size(); ++index) {
        const BoundaryCondition& condition = body.boundary[index];
        const std::array<const std::optional<Field>*, 2> displacement{&condition.displacement_x,
                                                                      &condition.displacement_y};
        const std::array<const std::optional<Field>*, 2> velocity{&condition.velocity_x,
                                                                  &condition.velocity_y};
        const std::array<bool, 2> fixed{condition.fixed_x, condition.fixed_y};
        for (std::size_t d = 0; d < 2; ++d) {
            if (fixed[d] + displacement[d]->has_value() + velocity[d]->has_value() > 1) {
                throw std::invalid_argument(
                    "Boundary '" + condition.name + "' of body '" + body.name
                    + "' tells the motion along " + (d == 0 ? "x" : "y")
                    + " twice; keep one of fixed, displacement and velocity.");
            }
        }
        for (const Edge& edge : edges_of(condition, body, boundary)) {
            if (!condition.traction.zero() || !condition.pressure.zero()) {
                edge_.push_back({edge.a, edge.b, condition.traction, condition.pressure});
                varies_ = varies_ || !condition.traction.steady() || !condition.pressure.zero();
            }
            for (const std::uint32_t i : {edge.a, edge.b}) {
                for (int d = 0; d < 2; ++d) {
                    const auto k = static_cast<std::size_t>(d);
                    if (*displacement[k]) {
                        hold(i, d, **displacement[k], false, index);
                    } else if (*velocity[k]) {
                        hold(i, d, **velocity[k], true, index);
                    } else if (fixed[k]) {
                        hold(i, d, 0, false, index);
                    }
                }
            }
        }
    }
    for (const PointLoad& load : body.point_load) {
        point_.push_back({nearest_node(body.mesh, load.at), load.force});
        varies_ = varies_ || !load.force.steady();
    }
}

void Loads::hold(
    std::uint32_t node, int direction, const Field& value, bool velocity, std::size_t condition) {
    const std::uint32_t component = 2 * node + static_cast<std::uint32_t>(direction);
    const auto at =
        std::lower_bound(held_.begin(), held_.end(), component, [](const Held& h, std::uint32_t c) {
            return h.component < c;
        });
    if (at != held_.end() && at->component == component) {
        *at = {component, place_[node], value, velocity, condition}; // the later condition rules
    } else {
        held_.insert(at, {component, place_[node], value, velocity, condition});
    }
    moves_ = moves_ || (velocity ? !value.zero() : !value.steady());
}

void Loads::forces(double time, std::span<const double> position, std::span<double> out) const {
    std::copy(body_force_.begin(), body_force_.end(), out.begin());
    const auto add = [&](std::uint32_t node, const Point& force) {
        out[2 * node] += force.x();
        out[2 * node + 1] += force.y();
    };
    for (const OnEdge& edge : edge_) {
        const double sixth = (place_[edge.b] - place_[edge.a]).norm() / 6;
        const Point a = edge.traction(place_[edge.a], time),
                    b = edge.traction(place_[edge.b], time);
        add(edge.a, sixth * (2 * a + b));
        add(edge.b, sixth * (a + 2 * b));
        if (!edge.pressure.zero()) { // the body lies to the left of the way from a to b
            const Point inward(-(position[2 * edge.b + 1] - position[2 * edge.a + 1]),
                               position[2 * edge.b] - position[2 * edge.a]);
            const double p = edge.pressure(place_[edge.a], time);
            const double q = edge.pressure(place_[edge.b], time);
            add(edge.a, (2 * p + q) / 6 * inward);
            add(edge.b, (p + 2 * q) / 6 * inward);
        }
    }
    for (const OnNode& point : point_) {
        add(point.node, point.force(place_[point.node], time));
    }
}

} // namespace duet::solid
