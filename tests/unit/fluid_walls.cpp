// The cavity's own walls: holes, arcs, and values that depend on place and time.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace duet::fluid::test {
namespace {

constexpr double pi = std::numbers::pi;

Config annulus(double inner, double outer, double spacing) {
    Config config = closed(circle({0, 0}, outer, spacing), spacing, false);
    config.holes = {circle({0, 0}, inner, spacing)};
    return config;
}

TEST(FluidWalls, APolygonHasTheAreaOfItsCircleAndFollowsIt) {
    const double spacing = 0.05;
    const std::vector<Vec2> corners = circle({1, 2}, 0.7, spacing);
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
        twice += cross(a, b);
        EXPECT_LE(norm(b - a), 2 * spacing * 1.001);
        EXPECT_NEAR(norm(0.5 * (a + b) - Vec2{1, 2}), 0.7, 0.02 * spacing);
    }
    EXPECT_NEAR(twice / 2, pi * 0.49, 1e-12);
}

TEST(FluidWalls, AHoleIsCutOut) {
    Config config = closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, 0.05, true);
    config.holes = {{{0.5, 0.5}, {0.9, 0.5}, {0.9, 0.9}, {0.5, 0.9}},
                    {{1.2, 1.2}, {1.2, 1.6}, {1.6, 1.2}}}; // either order of the corners
    config.walls.push_back({.name = "core", .temperature = 3.0, .around = 1});
    const Boundary boundary(config, {}, {});
    EXPECT_NEAR(boundary.area(), 4 - 0.16 - 0.08, 1e-13);
    EXPECT_FALSE(boundary.contains({0.7, 0.7}));
    EXPECT_FALSE(boundary.contains({1.3, 1.3}));
    EXPECT_TRUE(boundary.contains({1.0, 0.7}));
    EXPECT_NEAR(boundary.wall_length()[4], 1.6, 1e-13);
    EXPECT_EQ(boundary.nearest({0.5, 0.48}).face->heated, true);
    EXPECT_EQ(boundary.at(*boundary.nearest({0.7, 0.48}).face, 0.2).value[3], 3);
    EXPECT_EQ(boundary.nearest({1.4, 1.18}).face->heated, false) << "the other hole";
}

TEST(FluidWalls, ABodyMayLeanOnAHole) {
    // A square body whose left side covers part of the right side of a square hole.
    Config config = closed({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, 0.05, true);
    config.holes = {{{0.5, 0.5}, {1, 0.5}, {1, 1.5}, {0.5, 1.5}}};
    InterfaceState state;
    state.position = {{1, 0.8}, {1.2, 0.8}, {1.2, 1.2}, {1, 1.2}};
    state.velocity.resize(4);
    state.temperature.resize(4);
    const Boundary boundary(config, {{{0, 1, 2, 3}, false}}, state);
    EXPECT_NEAR(boundary.area(), 4 - 0.5 - 0.08, 1e-13);
    EXPECT_FALSE(boundary.contains({1.1, 1}));
    EXPECT_TRUE(boundary.contains({1.3, 1}));
}

TEST(FluidWalls, ValuesFollowPlaceAndTimeAndMoveAlongTheWall) {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    Wall lid{.name = "lid", .from = {0, 1}, .to = {1, 1}};
    lid.temperature = Function([](double x, double, double t) { return 2 * x + t; }, true);
    lid.velocity = {Function([](double x, double, double t) { return x * (1 - x) * t; }, true), 5};
    Wall floor{.name = "floor", .from = {0, 0}, .to = {1, 0}};
    floor.heat_flux = Function([](double x, double, double) { return 3 * x; }, false);
    config.walls = {lid, floor};
    config.conductivity = 1.5;
    Boundary boundary(config, {}, {});
    boundary.set_walls(4);
    for (const Face& face : boundary.faces()) {
        for (double arc = 0.05; arc < face.length; arc += 0.05) { // at the nodes
            const Vec2 x = face.a + arc * face.tangent;
            const WallPoint point = boundary.at(face, arc);
            if (face.normal.y > 0.5) {
                EXPECT_NEAR(point.value[3], 2 * x.x + 4, 1e-12);
                EXPECT_NEAR(point.value[0], 4 * x.x * (1 - x.x), 1e-12);
                EXPECT_EQ(point.value[1], 0) << "the wall keeps its place";
            } else if (face.normal.y < -0.5) {
                EXPECT_NEAR(point.value[3], 3 * x.x / 1.5, 1e-12) << "the slope q/k";
            } else {
                EXPECT_EQ(point.value[3], 0);
            }
        }
    }
}

/// The fluid turns with its walls as a solid does: pressure and velocity are known, v = w x r,
/// p = rho w^2 r^2/2, and nothing is sheared.
TEST(FluidWalls, SolidRotationStays) {
    Config config = annulus(0.5, 1, 0.05);
    const double rate = 2;
    config.walls = {{.name = "hub", .rotation = Rotation{{0, 0}, rate}, .around = 1},
                    {.name = "rim", .rotation = Rotation{{0, 0}, rate}, .around = 0}};
    config.kinematic_viscosity = 0.1;
    Fluid fluid(config);
    fluid.set_fields([&](Vec2 x) {
        return Values{0, rate * left(x), 0.5 * rate * rate * dot(x, x), {}};
    });
    fluid.advance(0.5); // a sixth of a turn
    for (const double r : {0.6, 0.75, 0.9}) {
        const Values v = fluid.at({0.8 * r, 0.6 * r});
        EXPECT_NEAR(v.velocity.x, -rate * 0.6 * r, 0.01 * rate);
        EXPECT_NEAR(v.velocity.y, rate * 0.8 * r, 0.01 * rate);
    }
    // A body at r in the turning fluid would be pressed inwards: p grows by rho w^2 r.
    EXPECT_NEAR(fluid.at({0.9, 0}).pressure - fluid.at({0.6, 0}).pressure,
                0.5 * rate * rate * (0.81 - 0.36),
                0.05 * 0.5 * rate * rate * 0.45);
    EXPECT_EQ(fluid.ledger().particles_outside, 0u);
}

/// With a known flux q through one wall and q out of the other the slab's slope is q/k; what is
/// booked is q.
TEST(FluidWalls, PrescribedHeatFlux) {
    Config config = closed({{0, 0}, {1, 0}, {1, 0.4}, {0, 0.4}}, 0.05, false);
    config.conductivity = 2;
    config.kinematic_viscosity = 1;
    config.disorder = 0.1;
    config.walls = {{.name = "in", .from = {0, 0}, .to = {0, 0.4}, .heat_flux = 3},
                    {.name = "out", .from = {1, 0}, .to = {1, 0.4}, .heat_flux = -3}};
    Fluid fluid(config);
    fluid.advance(0.5); // the slowest mode has died by exp(-2 pi^2 0.5)
    EXPECT_NEAR(fluid.at({0.2, 0.2}).temperature - fluid.at({0.8, 0.2}).temperature, 0.9, 2e-3);
    EXPECT_NEAR(fluid.walls()[0].heat, 3 * 0.4 * 0.5, 1e-12);
    EXPECT_NEAR(fluid.ledger().heat, 0, 1e-12);
}

/// The momentum that a cavity holds is what its walls and the body force gave it, but for what the
/// operators, accurate but not conservative, lose.
TEST(FluidWalls, BodyForceIsCarriedByTheWalls) {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.body_force = {0.5, -2};
    Fluid fluid(config);
    for (int k = 0; k < 20; ++k) {
        fluid.advance(0.05);
    }
    const Ledger l = fluid.ledger();
    EXPECT_NEAR(l.impulse_from_body_force.x, 0.5, 1e-12);
    EXPECT_NEAR(l.impulse_from_body_force.y, -2, 1e-12);
    EXPECT_NEAR(l.impulse_from_walls.x, -0.5, 0.02);
    EXPECT_NEAR(l.impulse_from_walls.y, 2, 0.04);
    EXPECT_NEAR(l.max_speed, 0, 0.02) << "the pressure balances it";
    EXPECT_NEAR(fluid.at({0.5, 0.3}).pressure - fluid.at({0.5, 0.7}).pressure, 0.8, 0.01);
}

/// c >= 10 sqrt(|b| dx): without viscosity nothing else sets it before the fluid moves, and the
/// pressure that balances the force has to be built up.
TEST(FluidWalls, BodyForceSetsTheSoundSpeed) {
    for (const double viscosity : {1e-6, 0.0}) {
        Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
        config.kinematic_viscosity = viscosity;
        config.body_force = {0.6, -0.8};
        Fluid fluid(config);
        EXPECT_NEAR(fluid.ledger().sound_speed, 10 * std::sqrt(0.05), 1e-9);
        fluid.advance(0.5);
        const Ledger l = fluid.ledger();
        EXPECT_GE(l.sound_speed, 10 * std::sqrt(0.05) * (1 - 1e-9));
        // Falling freely the fluid would be at 0.5 m/s by now.
        EXPECT_LT(l.max_speed, 0.1) << "viscosity " << viscosity;
        EXPECT_EQ(l.wall_hits, 0u);
    }
}

} // namespace
} // namespace duet::fluid::test
