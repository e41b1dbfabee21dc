// Vortices in a box whose walls slip, known in closed form.

#include "fluid_order.hpp"
#include "fluid_solver/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace duet::fluid::test {
namespace {

const double pi = std::numbers::pi;

/// u = (sin kx cos ky, -cos kx sin ky) U exp(-2 k^2 nu t), k = pi, in a unit square whose walls
/// slip: an exact solution of the Navier-Stokes equations. Root mean square error relative to U at
/// the time asked for.
double taylor_green_error(double spacing) {
    const double U = 5, time = 0.02;
    Config config;
    config.spacing = spacing;
    config.region = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    config.kinematic_viscosity = 1;
    config.sound_speed = 600; // as the pressure dies, div v = -(dp/dt)/(rho c^2/2): 3e-4
    config.walls = {{.name = "all", .around = 0, .slip = true}};
    Fluid fluid(config);
    const auto velocity = [&](Vec2 x, double t) {
        const double now = U * std::exp(-2 * pi * pi * t);
        return now
               * Vec2{std::sin(pi * x.x) * std::cos(pi * x.y),
                      -std::cos(pi * x.x) * std::sin(pi * x.y)};
    };
    fluid.set_fields([&](Vec2 x) {
        const double p = 0.25 * U * U * (std::cos(2 * pi * x.x) + std::cos(2 * pi * x.y));
        return Values{0, velocity(x, 0), p, {}};
    });
    fluid.advance(time);
    return velocity_error(fluid.snapshot(), [&](Vec2 x) { return velocity(x, time); }) / U;
}

TEST(FluidChannel, VorticesInABoxThatSlipsDecayAtSecondOrder) {
    expect_order({1.0 / 10, 1.0 / 20, 1.0 / 40, 1.0 / 60}, taylor_green_error, 1.8, 5e-5);
}

} // namespace
} // namespace duet::fluid::test
