#include "solid_solver/solid.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::solid {

Solid::Solid(std::vector<BodyConfig> bodies, const std::vector<Point>& region) {
    std::vector<BodyShape> shapes;
    for (BodyConfig& config : bodies) {
        bodies_.emplace_back(std::move(config));
        const Body& body = bodies_.back();
        shapes.push_back({body.config().name, &body.config().mesh, {}});
        for (std::size_t i = 0; i < body.nodes(); ++i) {
            shapes.back().place.emplace_back(body.position()[2 * i], body.position()[2 * i + 1]);
        }
        nodal_heat_.emplace_back(body.nodes(), 0.0);
        nodal_force_.emplace_back(2 * body.nodes(), 0.0);
    }
    if (!region.empty()) {
        interface_ = wet_interface(shapes, region);
    }
    wet_length_.assign(bodies_.size(), 0.0);
    for (const Interface::Segment& segment : interface_.segment) {
        const Interface::Node &a = interface_.node[segment.a], &b = interface_.node[segment.b];
        const Mesh& mesh = bodies_[a.body].config().mesh;
        wet_length_[a.body] += (mesh.node[b.node] - mesh.node[a.node]).norm();
    }
}

/// The fluid answers the velocity that it was told with the pressure Z v. Of a vibration with a
/// period between one and two windows that answer has the wrong sign: it feeds its energy by up to
/// 0.5 Z S/M (S the body's wet length, M its mass). A stiffness damping b takes b w^2, w >= pi over
/// the window. This b is a hundred times what balances the two where the whole body swings, for
/// surfaces swing more, and the layer beside them answers more than Z v
/// (docs/theory-coupling.md).
void Solid::damp_exchange(double length, double impedance) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b].set_exchange_damping(5 * impedance * wet_length_[b] / bodies_[b].mass() * length
                                        * length);
    }
}

std::uint32_t Solid::advance(double length,
                             std::span<const double> force,
                             std::span<const double> heat_flow,
                             double impedance) {
    set_loads(force, heat_flow);
    damp_exchange(length, impedance);
    interface_state(position_before_, velocity_, temperature_);
    std::uint32_t steps = 0;
    for (Body& body : bodies_) {
        steps = std::max(steps, body.advance(length));
    }
    interface_state(position_, velocity_, temperature_);
    book(length, force, heat_flow);
    return steps;
}

void Solid::set_loads(std::span<const double> force, std::span<const double> heat_flow) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        std::fill(nodal_heat_[b].begin(), nodal_heat_[b].end(), 0.0);
    }
    for (std::size_t j = 0; j < heat_flow.size(); ++j) {
        for (const std::uint32_t end : {interface_.segment[j].a, interface_.segment[j].b}) {
            const Interface::Node& node = interface_.node[end];
            nodal_heat_[node.body][node.node] += 0.5 * heat_flow[j];
        }
    }
    for (std::size_t i = 0; 2 * i < force.size(); ++i) {
        const Interface::Node& node = interface_.node[i];
        nodal_force_[node.body][2 * node.node] = force[2 * i];
        nodal_force_[node.body][2 * node.node + 1] = force[2 * i + 1];
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b].set_interface_load(nodal_heat_[b], nodal_force_[b]);
    }
}

void Solid::book(double length, std::span<const double> force, std::span<const double> heat_flow) {
    double heat = 0, absolute_heat = 0;
    for (const double flow : heat_flow) {
        heat += flow;
        absolute_heat += std::abs(flow);
    }
    double fx = 0, fy = 0, absolute_force = 0;
    for (std::size_t i = 0; 2 * i < force.size(); ++i) {
        fx += force[2 * i];
        fy += force[2 * i + 1];
        absolute_force += std::hypot(force[2 * i], force[2 * i + 1]);
    }
    for (std::size_t c = 0; c < force.size(); ++c) {
        account_.work += force[c] * (position_[c] - position_before_[c]);
    }
    account_.heat += heat * length;
    account_.exchanged_heat += absolute_heat * length;
    account_.impulse_x += fx * length;
    account_.impulse_y += fy * length;
    account_.exchanged_impulse += absolute_force * length;
}

void Solid::interface_state(std::vector<double>& position,
                            std::vector<double>& velocity,
                            std::vector<double>& temperature) const {
    const std::size_t nodes = interface_.node.size();
    position.resize(2 * nodes);
    velocity.resize(2 * nodes);
    temperature.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        const Interface::Node& node = interface_.node[i];
        const Body& body = bodies_[node.body];
        for (std::size_t d = 0; d < 2; ++d) {
            position[2 * i + d] = body.position()[2 * node.node + d];
            velocity[2 * i + d] = body.velocity()[2 * node.node + d];
        }
        temperature[i] = body.temperature()[node.node];
    }
}

/// The smallest positive limit(body, length of the edge) of all wet edges; 0: none.
template <class Limit>
double Solid::least_over_segments(const Limit& limit) const {
    double least = 0;
    for (const Interface::Segment& segment : interface_.segment) {
        const Interface::Node &a = interface_.node[segment.a], &b = interface_.node[segment.b];
        const BodyConfig& body = bodies_[a.body].config();
        const double one = limit(body, (body.mesh.node[b.node] - body.mesh.node[a.node]).norm());
        if (one > 0) {
            least = least == 0 ? one : std::min(least, one);
        }
    }
    return least;
}

namespace {

/// The smaller of a limit, 0 being none, and the inverse of a rate.
double smaller_limit(double limit, double rate) {
    return rate <= 0 ? limit : limit > 0 ? std::min(limit, 1 / rate) : 1 / rate;
}

/// The smallest density of a body's materials, kg/m3.
double lightest(const BodyConfig& body) {
    double least = std::numeric_limits<double>::infinity();
    for (const Material& material : body.materials()) {
        least = std::min(least, material.density);
    }
    return least;
}

} // namespace

double Solid::exchange_limit(double conductivity, double spacing) const {
    if (conductivity <= 0) {
        return 0;
    }
    return least_over_segments([&](const BodyConfig& body, double edge) {
        if (body.insulated) {
            return 0.0;
        }
        double least = std::numeric_limits<double>::infinity();
        for (const Material& material : body.materials()) {
            least = std::min(least, material.density * material.heat_capacity);
        }
        const double layer = least * edge / 2;
        return 0.5 * layer * (spacing / 2) / conductivity;
    });
}

double Solid::added_mass_limit(double fluid_density, double sound_speed) const {
    if (sound_speed <= 0) {
        return 0;
    }
    const double impedance = fluid_density * sound_speed;
    const double layers = least_over_segments([&](const BodyConfig& body, double edge) {
        const bool moves = body.motion == Motion::deformable;
        return moves ? lightest(body) * edge / impedance : 0;
    });
    return smaller_limit(layers, rigid_rate(impedance, 0));
}

double Solid::rigid_rate(double across, double along_it) const {
    std::vector<Eigen::Matrix3d> sum(bodies_.size(), Eigen::Matrix3d::Zero());
    for (const Interface::Segment& segment : interface_.segment) {
        const Interface::Node &a = interface_.node[segment.a], &b = interface_.node[segment.b];
        const Body& body = bodies_[a.body];
        if (!body.rigid()) {
            continue;
        }
        const auto x = body.position();
        const Point from(x[2 * a.node], x[2 * a.node + 1]), to(x[2 * b.node], x[2 * b.node + 1]);
        const Point along = to - from, arm = 0.5 * (from + to) - body.rigid()->centre();
        // Times the edge's length: the normal and the tangent, with their arms.
        const Eigen::Vector3d mass = body.rigid()->inverse_mass().cwiseSqrt();
        const Eigen::Vector3d n =
            mass.cwiseProduct(Eigen::Vector3d(along.y(), -along.x(), -arm.dot(along)));
        const Eigen::Vector3d t = mass.cwiseProduct(
            Eigen::Vector3d(along.x(), along.y(), arm.x() * along.y() - arm.y() * along.x()));
        sum[a.body] += (across * n * n.transpose() + along_it * t * t.transpose()) / along.norm();
    }
    double largest = 0;
    for (const Eigen::Matrix3d& one : sum) {
        largest =
            std::max(largest,
                     Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(one, Eigen::EigenvaluesOnly)
                         .eigenvalues()
                         .z());
    }
    return largest;
}

double Solid::drag_limit(double viscosity, double spacing) const {
    if (viscosity <= 0) {
        return 0;
    }
    const double drag = 2 * viscosity / (spacing / 2);
    const double layers = least_over_segments([&](const BodyConfig& body, double edge) {
        return body.motion == Motion::deformable ? lightest(body) * edge / 2 / drag : 0;
    });
    return smaller_limit(layers, rigid_rate(0, drag));
}

} // namespace duet::solid
