// A moving interface that comes too near to what it does not hang together with ends the run.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace duet::fluid::test {
namespace {

constexpr double dx = 0.05;
const std::vector<Vec2> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

double narrowest(const Boundary& boundary) {
    std::vector<Boundary::Gap> gaps;
    boundary.find_gaps(1.25 * dx, gaps);
    double width = std::numeric_limits<double>::infinity();
    for (const Boundary::Gap& gap : gaps) {
        width = std::min(width, gap.width);
    }
    return width;
}

double narrowest(const std::vector<std::vector<Vec2>>& bodies,
                 bool closed_chains = true,
                 Periodic periodic = {},
                 double drifted = 0) {
    std::vector<Chain> chains;
    InterfaceState state;
    for (const std::vector<Vec2>& corners : bodies) {
        Chain chain;
        chain.closed = closed_chains;
        for (const Vec2 x : corners) {
            chain.nodes.push_back(static_cast<std::uint32_t>(state.position.size()));
            state.position.push_back(x);
        }
        chains.push_back(chain);
    }
    state.velocity.resize(state.position.size());
    state.temperature.resize(state.position.size());
    Config config = closed(square, dx, false);
    config.periodic = periodic;
    Boundary boundary(config, chains, state);
    for (Vec2& x : state.position) {
        x.x += drifted;
    }
    boundary.place(state.position);
    return narrowest(boundary);
}

TEST(FluidContact, GapsLieBetweenWhatDoesNotHangTogether) {
    const auto box = [](Vec2 a, Vec2 b) { return std::vector<Vec2>{a, {b.x, a.y}, b, {a.x, b.y}}; };
    EXPECT_NEAR(narrowest({box({0.4, 0.4 * dx}, {0.6, 0.3})}), 0.4 * dx, 1e-12) << "a wall";
    EXPECT_NEAR(narrowest({box({0.2, 0.2}, {0.5, 0.5}), box({0.5 + 0.3 * dx, 0.3}, {0.8, 0.4})}),
                0.3 * dx,
                1e-12)
        << "another body";
    // A slot of 0.2 spacings, 0.3 m deep, in one body; its lips face each other.
    EXPECT_NEAR(narrowest({{{0.3, 0.3},
                            {0.7, 0.3},
                            {0.7, 0.5},
                            {0.4, 0.5},
                            {0.4, 0.5 + 0.2 * dx},
                            {0.7, 0.5 + 0.2 * dx},
                            {0.7, 0.7},
                            {0.3, 0.7}}}),
                0.2 * dx,
                1e-12)
        << "the same body";
    EXPECT_GT(narrowest({box({0.4, 1.3 * dx}, {0.6, 0.3})}), dx) << "wide enough";
    EXPECT_GT(narrowest({box({0.4, 0.4}, {0.6, 0.4 + 0.1 * dx})}), dx) << "a thin plate is no gap";
    // Leaning on the floor: upright, and like a wedge of 30 degrees.
    EXPECT_GT(
        narrowest({{{0.6, 0}, {0.6, 0.01}, {0.6, 0.4}, {0.4, 0.4}, {0.4, 0.01}, {0.4, 0}}}, false),
        dx);
    EXPECT_GT(narrowest({{{0.6, 0}, {0.62, 0.01155}, {0.7, 0.0577}, {0.4, 0.4}, {0.4, 0}}}, false),
              dx);
}

TEST(FluidContact, GapsOfBodiesThatHaveGonePeriodsFar) {
    const auto box = [](Vec2 a, Vec2 b) { return std::vector<Vec2>{a, {b.x, a.y}, b, {a.x, b.y}}; };
    for (const double way : {0.0, 0.4, 3.3, -7.1}) {
        EXPECT_NEAR(narrowest({box({0.2, 0.2}, {0.5, 0.5}), box({0.5 + 0.3 * dx, 0.3}, {0.8, 0.4})},
                              true,
                              {true, false},
                              way),
                    0.3 * dx,
                    1e-9)
            << way;
    }
    // One that leans on the floor beside the seam: the floor goes on behind it.
    for (const double left : {0.3, 0.02, 0.002}) {
        const double right = left + 0.15;
        EXPECT_GT(
            narrowest(
                {{{right, 0}, {right, 0.01}, {right, 0.15}, {left, 0.15}, {left, 0.01}, {left, 0}}},
                false,
                {true, false}),
            dx)
            << left;
    }
}

/// A body that falls on the floor: names, place, time.
TEST(FluidContact, ABodyThatReachesAWallEndsTheRun) {
    Config config = closed(square, dx, false);
    config.walls = {{.name = "floor", .from = {0, 0}, .to = {1, 0}}};
    config.conductivity = 0;
    config.kinematic_viscosity = 1e-3;
    std::vector<Chain> chains;
    InterfaceState now;
    square_body({0.4, 2 * dx}, 0.2, 8, chains, now);
    chains[0].name = "brick";
    const auto falling = static_cast<std::ptrdiff_t>(now.position.size());
    const double window = 0.1 * dx; // a tenth of a spacing, at 1 m/s
    std::fill(now.velocity.begin(), now.velocity.end(), Vec2{0, -1});
    // Two more that stand nearly in touch make no difference.
    square_body({0.05, 0.5}, 0.2, 8, chains, now);
    square_body({0.25 + 0.01 * dx, 0.5}, 0.2, 8, chains, now);
    Fluid fluid(config, chains, now);
    std::string sentence;
    for (int k = 0; k < 20 && sentence.empty(); ++k) {
        const InterfaceState before = now;
        std::for_each(
            now.position.begin(), now.position.begin() + falling, [&](Vec2& x) { x.y -= window; });
        try {
            fluid.advance(window, before, now);
        } catch (const Diverged& error) {
            sentence = error.what();
        }
    }
    // 2 spacings at the start, 1.2 after eight windows.
    EXPECT_NEAR(now.position[0].y, 1.2 * dx, 1e-9);
    EXPECT_NEAR(fluid.time(), 0.7 * dx, 1e-9);
    for (const char* part : {"the surface of 'brick' and wall 'floor' have come within 1.2 ",
                             "spacings of each other at (0.4, 0.06) at t = 0.04 s",
                             "refine fluid.spacing"}) {
        EXPECT_NE(sentence.find(part), std::string::npos) << part << " in: " << sentence;
    }
}

} // namespace
} // namespace duet::fluid::test
