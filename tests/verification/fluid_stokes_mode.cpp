// A slow vortex in a closed no-slip square dies as exp(-52.34469 nu t/L^2): viscosity, pressure and
// no-slip walls without anything else.

#include "fluid_solver/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace duet::fluid {
namespace {

/// Rate of decay of the velocity between t = 0.06 and 0.09 (in L^2/nu).
double decay_rate(int particles_across) {
    Config config;
    config.spacing = 1.0 / particles_across;
    config.region = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    config.kinematic_viscosity = 1;
    config.sound_speed = 100;
    Fluid fluid(config);
    // psi = sin^2(pi x) sin^2(pi y), slow enough for the inertia to vanish.
    fluid.set_fields([](Vec2 x) {
        const double pi = std::numbers::pi, sx = std::sin(pi * x.x), sy = std::sin(pi * x.y);
        return Values{
            0, 1e-3 * Vec2{sx * sx * std::sin(2 * pi * x.y), -sy * sy * std::sin(2 * pi * x.x)}, 0};
    });
    fluid.advance(0.06);
    const double before = fluid.ledger().kinetic_energy;
    fluid.advance(0.03);
    return std::log(before / fluid.ledger().kinetic_energy) / (2 * 0.03);
}

// (The errors are -0.031 % and +0.017 %: too small to have an order.)
TEST(FluidStokesMode, DecaysAtItsRate) {
    const double exact = 52.34469;
    EXPECT_NEAR(decay_rate(20), exact, 0.0006 * exact);
    EXPECT_NEAR(decay_rate(40), exact, 0.0004 * exact);
}

} // namespace
} // namespace duet::fluid
