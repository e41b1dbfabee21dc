// Static problems with known answers, shared by the tests and the table of error against cost.

#pragma once

#include "solid_solver/locator.hpp"
#include "tests/unit/solid_support.hpp"

namespace duet::solid::test {

inline Point displacement_at(const Body& body, const Point& place) {
    const std::size_t i = nearest_node(body.config().mesh, place);
    return Point(body.position()[2 * i], body.position()[2 * i + 1]) - body.config().mesh.node[i];
}

inline BoundaryCondition on_curve(const std::string& name) {
    BoundaryCondition condition;
    condition.name = condition.curve = name;
    return condition;
}

inline BoundaryCondition clamp(const std::string& name) {
    BoundaryCondition condition = on_curve(name);
    condition.fixed_x = condition.fixed_y = true;
    return condition;
}

/// A body without heat effects.
inline BodyConfig elastic(Mesh mesh, double youngs_modulus, double poissons_ratio) {
    BodyConfig config;
    config.name = "body";
    config.mesh = std::move(mesh);
    config.motion = Motion::deformable;
    config.material.youngs_modulus = youngs_modulus;
    config.material.poissons_ratio = poissons_ratio;
    return config;
}

/// Cook's membrane of n x n cells, each of two triangles: clamped at the left, a total shear of
/// `force` on the right side.
inline BodyConfig
cook(std::uint32_t n, Smoothing smoothing, double young, double poisson, double force) {
    Mesh mesh = rectangle_mesh({0, 0}, 1, 1, 1.0 / n);
    for (Point& p : mesh.node) {
        const double bottom = 44 * p.x(), top = 44 + 16 * p.x();
        p = {48 * p.x(), bottom + (top - bottom) * p.y()};
    }
    BodyConfig config = elastic(std::move(mesh), young, poisson);
    config.smoothing = smoothing;
    config.boundary = {clamp("left"), on_curve("right")};
    config.boundary[1].traction = {0, force / 16};
    return config;
}

/// Cook's deflection at (48, 52) per unit of force, small strains; 21.52 is exact to 0.02 %.
inline double cook_deflection(std::uint32_t n, Smoothing smoothing) {
    constexpr double force = 1e-4;
    Body body(cook(n, smoothing, 1, 1.0 / 3, force));
    body.find_equilibrium(1e-10);
    return displacement_at(body, {48, 52}).y() / force;
}

} // namespace duet::solid::test
