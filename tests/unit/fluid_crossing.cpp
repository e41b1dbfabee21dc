// No particle crosses a wall: pushed off, slowed down, held off, or the end of the run.

#include "fluid_support.hpp"

#include "fluid_solver/shifting.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace duet::fluid::test {
namespace {

constexpr double dx = 0.05;
const std::vector<Vec2> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/// A square body, four spacings wide, in a fluid at rest without viscosity and heat, half a spacing
/// from the next particles. The sound is slow, so that a single step moves the body as far as asked
/// for, and the pressure has hardly a part in it.
struct Paddle {
    static constexpr double speed = 1;
    Config config = closed(square, dx, false);
    std::vector<Chain> chains;
    InterfaceState start, end;
    double window;

    /// The body goes `way` along x in one window.
    explicit Paddle(double way) : window(way / speed) {
        config.kinematic_viscosity = config.conductivity = 0;
        config.sound_speed = 0.51 * speed;
        square_body({0.4, 0.4}, 0.2, 8, chains, start);
        chains[0].name = "paddle";
        end = start;
        for (Vec2& x : end.position) {
            x.x += way;
        }
    }
};

TEST(FluidCrossing, ACornerThatJutsOutPushesOff) {
    std::vector<Chain> chains;
    InterfaceState state;
    square_body({0.4, 0.4}, 0.2, 8, chains, state);
    const Config config = closed(square, dx, false);
    const Boundary boundary(config, chains, state);
    Particles particles = cloud(boundary, config, 0);
    const Vec2 place{0.6 + 0.03 * dx, 0.6 + 0.04 * dx}; // 0.05 spacings before the corner
    particles.x[0] = place.x;
    particles.y[0] = place.y;
    particles.sort(boundary.grid());
    Evaluation evaluation(dx, 1);
    evaluation.run(particles, boundary.grid(), boundary, {dx, dx * dx, 0, 0, 0, false});
    const auto a = static_cast<std::size_t>(
        std::find(particles.x.begin(), particles.x.end(), place.x) - particles.x.begin());
    ASSERT_LT(a, particles.size());
    EXPECT_NEAR(evaluation.shift[a].x, 0.6 * wall_push(0.05 * dx, dx), 1e-12);
    EXPECT_NEAR(evaluation.shift[a].y, 0.8 * wall_push(0.05 * dx, dx), 1e-12);
}

TEST(FluidCrossing, TheFirstSegmentOnTheWayIsFound) {
    // A plate a tenth of a spacing thick, its long sides along y.
    std::vector<Chain> chains{{{0, 1, 2, 3}, true}};
    InterfaceState state;
    state.position = {{0.5, 0.3}, {0.505, 0.3}, {0.505, 0.7}, {0.5, 0.7}};
    state.velocity.resize(4);
    state.temperature.resize(4);
    Boundary boundary(closed(square, dx, false), chains, state);
    const std::vector<Vec2> before = state.position;
    const auto through = boundary.first_crossing({0.49, 0.5}, {0.51, 0.52}, before);
    ASSERT_TRUE(through.has_value()) << "through both sides, and in the fluid again";
    EXPECT_EQ(boundary.segments()[through->segment].node_a, 3u) << "the left side comes first";
    EXPECT_NEAR(through->depth, 0.01, 1e-12);
    EXPECT_NEAR(through->along, 0.45, 1e-12) << "from the top down, at the way's end";
    EXPECT_FALSE(boundary.first_crossing({0.49, 0.71}, {0.51, 0.705}, before)) << "above it";
    EXPECT_FALSE(boundary.first_crossing({0.501, 0.5}, {0.49, 0.5}, before)) << "from within";
    EXPECT_TRUE(boundary.first_crossing({0.01, 0.5}, {-0.001, 0.5}, before)) << "a fixed wall";

    // The plate passes a point at rest.
    for (Vec2& x : state.position) {
        x.x += 0.02;
    }
    boundary.place(state.position);
    const auto passed = boundary.first_crossing({0.515, 0.5}, {0.515, 0.5}, before);
    ASSERT_TRUE(passed.has_value());
    EXPECT_EQ(boundary.segments()[passed->segment].node_a, 1u) << "its right side";
    EXPECT_NEAR(passed->depth, 0.01, 1e-12);
    EXPECT_EQ(boundary.name(boundary.segments()[passed->segment]), "chain 0 of the interface");
}

/// The body runs into four particles at rest in the second half of its step: they come away with
/// its speed, and what they gained is booked as its impulse, the work it did as what they hold and
/// what was lost.
TEST(FluidCrossing, WhatIsHeldOffIsCountedAndBooked) {
    Paddle scene(0.62 * dx);
    Fluid fluid(scene.config, scene.chains, scene.start);
    ASSERT_EQ(fluid.advance(scene.window, scene.start, scene.end), 1) << "in one step";
    const Ledger l = fluid.ledger();
    const double gained = 4 * fluid.particle_volume() * scene.speed;
    EXPECT_EQ(l.wall_hits, 4u);
    EXPECT_EQ(l.particles_outside, 0u);
    EXPECT_NEAR(l.momentum.x, gained, 1e-6 * gained);
    // A fifth more is the pressure's, which has hardly moved the fluid yet.
    EXPECT_NEAR(l.impulse_from_interface.x, gained, 0.25 * gained);
    EXPECT_NEAR(l.kinetic_energy, 0.5 * gained * scene.speed, 1e-6 * gained);
    EXPECT_NEAR(l.wall_hit_loss, 0.5 * gained * scene.speed, 0.1 * gained);
    EXPECT_NEAR(l.work_from_interface, gained * scene.speed, 0.25 * gained);
    double passed = 0;
    for (const Vec2 impulse : fluid.passed().impulse) {
        passed += impulse.x;
    }
    EXPECT_NEAR(passed, -l.impulse_from_interface.x, 1e-14) << "what is sent is what is booked";
}

/// With the wall coming near, a particle goes d0 exp(-s/d0) instead of d0 - s.
TEST(FluidCrossing, WhatComesCloseSlowsDown) {
    Paddle scene(0.45 * dx);
    Fluid fluid(scene.config, scene.chains, scene.start);
    ASSERT_EQ(fluid.advance(scene.window, scene.start, scene.end), 1);
    double least = 1;
    for (const Vec2 x : fluid.snapshot().position) {
        if (std::abs(x.y - 0.5) < 0.1 && x.x > 0.5) {
            least = std::min(least, x.x - scene.end.position[10].x);
        }
    }
    const double d0 = 0.275 * dx, s = 0.225 * dx; // in the second half of the step
    EXPECT_NEAR(least, d0 * std::exp(-s / d0), 0.03 * dx) << "0.05 spacings if it did not";
    EXPECT_EQ(fluid.ledger().wall_hits, 0u);
}

TEST(FluidCrossing, WhatAWallPassesEndsTheRun) {
    Paddle scene(2 * dx);
    Fluid fluid(scene.config, scene.chains, scene.start);
    try {
        fluid.advance(scene.window, scene.start, scene.end);
        FAIL() << "the body went through four particles";
    } catch (const Diverged& error) {
        const std::string sentence = error.what();
        for (const char* part :
             {"a fluid particle has crossed the surface of 'paddle' at (0.65, 0.4",
              "at t = 0.05 s",
              "0.5 spacings behind it",
              "the wall moved by 1 spacings",
              "shorten time.window"}) {
            EXPECT_NE(sentence.find(part), std::string::npos) << part << " in: " << sentence;
        }
    }
}

/// What one half step throws through a wall from so far away that no wall was in its sight before
/// is found there all the same.
TEST(FluidCrossing, WhatIsThrownThroughAWallFromAfarEndsTheRun) {
    Config config = closed(square, dx, false);
    config.kinematic_viscosity = config.conductivity = 0;
    config.sound_speed = 0.05;
    config.body_force.x = Function(
        [](double x, double y, double) {
            return std::abs(x - 0.525) < 0.01 && std::abs(y - 0.525) < 0.01 ? 1.0 : 0.0;
        },
        false);
    Fluid fluid(config);
    // One particle goes t^2/2, from the middle through the wall.
    try {
        fluid.advance(1.2);
        FAIL() << "it went through the wall";
    } catch (const Diverged& error) {
        EXPECT_NE(std::string(error.what()).find("a fluid particle has crossed"), std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace duet::fluid::test
