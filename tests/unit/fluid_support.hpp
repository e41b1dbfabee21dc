// Small scenes and clouds that the fluid's unit tests share.

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/evaluation.hpp"
#include "fluid_solver/fluid.hpp"

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace duet::fluid::test {

/// The region with every side as a wall of its own at temperature 0, or adiabatic.
inline Config closed(const std::vector<Vec2>& region, double spacing, bool heated) {
    Config config;
    config.spacing = spacing;
    config.region = region;
    config.conductivity = 1;
    config.kinematic_viscosity = 1;
    for (std::size_t i = 0; heated && i < region.size(); ++i) {
        config.walls.push_back(
            {"side " + std::to_string(i), region[i], region[(i + 1) % region.size()], 0.0, {}});
    }
    return config;
}

/// Particles on the lattice of `spacing` within the boundary, moved at random by up to `disorder`
/// spacings, sorted.
inline Particles cloud(const Boundary& boundary, const Config& config, double disorder) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-disorder * config.spacing,
                                                  disorder * config.spacing);
    std::vector<Vec2> places;
    Vec2 lower = config.region[0], upper = lower;
    for (const Vec2 c : config.region) {
        lower = {std::min(lower.x, c.x), std::min(lower.y, c.y)};
        upper = {std::max(upper.x, c.x), std::max(upper.y, c.y)};
    }
    for (double y = lower.y + config.spacing / 2; y < upper.y; y += config.spacing) {
        for (double x = lower.x + config.spacing / 2; x < upper.x; x += config.spacing) {
            const Vec2 place = boundary.grid().wrapped({x + jitter(random), y + jitter(random)});
            if (boundary.contains(place) && boundary.distance(place) > 0.2 * config.spacing) {
                places.push_back(place);
            }
        }
    }
    Particles particles;
    particles.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        particles.x[i] = places[i].x;
        particles.y[i] = places[i].y;
        particles.identity[i] = static_cast<std::uint32_t>(i);
    }
    particles.sort(boundary.grid());
    return particles;
}

using Field = std::function<double(Vec2)>;

/// Gives every node of the boundary the values of the fields at its place.
inline void set_walls(Boundary& boundary, const Field& u, const Field& v, const Field& T) {
    std::size_t nodes = boundary.interface_nodes();
    for (const Segment& s : boundary.segments()) {
        nodes = std::max<std::size_t>(nodes, std::max(s.node_a, s.node_b) + 1);
    }
    std::vector<Vec2> velocity(nodes);
    std::vector<double> temperature(nodes);
    for (const Segment& s : boundary.segments()) {
        velocity[s.node_a] = {u(s.a), v(s.a)};
        velocity[s.node_b] = {u(s.b), v(s.b)};
    }
    for (const Face& face : boundary.faces()) { // else the nodes hold the slope, here none
        for (std::uint32_t j = face.first; face.heated && j < face.first + face.segments; ++j) {
            const Segment& s = boundary.segments()[j];
            temperature[s.node_a] = T(s.a);
            temperature[s.node_b] = T(s.b);
        }
    }
    boundary.set_values(velocity, std::vector<Vec2>(nodes), temperature);
}

inline void set_fields(Particles& particles, const Field& u, const Field& v, const Field& T) {
    for (std::size_t a = 0; a < particles.size(); ++a) {
        const Vec2 x = particles.position(a);
        particles.fields[a] = {u(x), v(x), 0, T(x)};
    }
}

/// The square body's wet chain, counter-clockwise, `count` segments a side.
inline void square_body(Vec2 corner,
                        double side,
                        std::uint32_t count,
                        std::vector<Chain>& chains,
                        InterfaceState& state) {
    Chain chain;
    chain.closed = true;
    const Vec2 corners[] = {
        corner, corner + Vec2{side, 0}, corner + Vec2{side, side}, corner + Vec2{0, side}};
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const double w = static_cast<double>(i) / count;
            chain.nodes.push_back(static_cast<std::uint32_t>(state.position.size()));
            state.position.push_back((1 - w) * corners[k] + w * corners[(k + 1) % 4]);
            state.velocity.push_back({});
            state.temperature.push_back(0);
        }
    }
    chains.push_back(chain);
}

} // namespace duet::fluid::test
