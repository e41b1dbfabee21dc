// The heated cavity at Ra = 1e5, Pr = 0.71 (cases/heated_cavity deepens it): all operators together
// against the spectral solution.

#include "fluid_order.hpp"
#include "fluid_solver/fluid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace duet::fluid {
namespace {

Config cavity(double spacing) {
    const double Ra = 1e5, Pr = 0.71;
    Config config; // lengths in L, time in L^2/alpha
    config.spacing = spacing;
    config.region = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    config.kinematic_viscosity = Pr;
    config.conductivity = 1;
    config.thermal_expansion = 1;
    config.gravity = {0, -Ra * Pr};
    config.initial_temperature = config.reference_temperature = 0.5;
    config.walls = {{"hot", {0, 0}, {0, 1}, 1.0, {}}, {"cold", {1, 0}, {1, 1}, 0.0, {}}};
    return config;
}

TEST(FluidCavity, NusseltNumberOfTheWallsConverges) {
    const auto error = [](double spacing) {
        Fluid fluid(cavity(spacing));
        fluid.advance(0.1);
        double nusselt = 0;
        for (int k = 0; k < 20; ++k) {
            fluid.advance(0.0015);
            nusselt += (fluid.walls()[0].heat_flow - fluid.walls()[1].heat_flow) / 40;
        }
        return std::abs(nusselt / 4.5216 - 1);
    };
    test::expect_order({1.0 / 16, 1.0 / 22, 1.0 / 30}, error, 1.6, 0.012);
}

TEST(FluidCavity, NusseltNumberAndVelocities) {
    Fluid fluid(cavity(1.0 / 40));
    fluid.advance(0.1);
    double nusselt = 0, umax = 0, vmax = 0;
    const int samples = 10;
    for (int k = 0; k < samples; ++k) {
        fluid.advance(0.002);
        nusselt += (fluid.walls()[0].heat_flow - fluid.walls()[1].heat_flow) / (2 * samples);
        double u = 0, v = 0;
        for (int i = 1; i < 200; ++i) {
            u = std::max(u, fluid.at({0.5, i / 200.0}).velocity.x);
            v = std::max(v, fluid.at({i / 200.0, 0.5}).velocity.y);
        }
        umax += u / samples;
        vmax += v / samples;
    }
    // Measured -0.1, -0.7 and -1.6 % at this spacing.
    EXPECT_NEAR(nusselt, 4.5216, 0.005 * 4.5216);
    EXPECT_NEAR(umax, 34.741, 0.015 * 34.741);
    EXPECT_NEAR(vmax, 68.639, 0.025 * 68.639);
    const Ledger l = fluid.ledger();
    EXPECT_NEAR(l.heat, l.heat_from_walls, 1e-11);
    EXPECT_EQ(l.wall_hits, 0u);
}

} // namespace
} // namespace duet::fluid
