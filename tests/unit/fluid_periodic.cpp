// Regions that repeat themselves: what lies over a periodic side is seen, whatever its place in the
// period, and nothing is lost on the way over it.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <utility>

namespace duet::fluid::test {
namespace {

constexpr double spacing = 0.1;

std::vector<Vec2> rectangle(Vec2 lower, Vec2 upper) {
    return {lower, {upper.x, lower.y}, upper, {lower.x, upper.y}};
}

std::vector<Vec2> moved(std::vector<Vec2> corners, Vec2 way) {
    for (Vec2& c : corners) {
        c += way;
    }
    return corners;
}

TEST(FluidPeriodic, NeighboursAreThoseOfAllPairs) {
    // Periods of two cells, of a little less and more than three, and of many.
    for (const Vec2 upper : {Vec2{0.6, 0.77}, Vec2{0.79, 2}, Vec2{2, 0.61}}) {
        for (const Periodic periodic :
             {Periodic{true, false}, Periodic{false, true}, Periodic{true, true}}) {
            const float support = 0.26F;
            const CellGrid grid({0, 0}, upper, support, periodic);
            std::mt19937 random(5);
            std::uniform_real_distribution<double> part(0, 1);
            Particles particles;
            particles.resize(static_cast<std::size_t>(upper.x * upper.y / 0.01));
            for (std::size_t i = 0; i < particles.size(); ++i) {
                particles.x[i] = upper.x * part(random);
                particles.y[i] = upper.y * part(random);
            }
            particles.sort(grid);
            static Surroundings surroundings;
            Neighbours found;
            for (std::size_t a = 0; a < particles.size(); ++a) {
                const Vec2 x = particles.position(a);
                ASSERT_TRUE(surroundings.collect(particles, grid, grid.column(x.x), grid.row(x.y)));
                ASSERT_TRUE(surroundings.find(x, support, found));
                std::map<std::uint32_t, Vec2> expected;
                for (std::uint32_t b = 0; b < particles.size(); ++b) {
                    for (const int i : {-1, 0, 1}) {
                        for (const int j : {-1, 0, 1}) {
                            const Vec2 r = x - particles.position(b)
                                           + Vec2{periodic.x ? i * upper.x : 10 * i,
                                                  periodic.y ? j * upper.y : 10 * j};
                            if (b != a && norm(r) < support) {
                                expected[b] = r;
                            }
                        }
                    }
                }
                ASSERT_EQ(found.count, expected.size());
                for (std::size_t k = 0; k < found.count; ++k) {
                    ASSERT_EQ(expected.count(found.index[k]), 1u);
                    const Vec2 r = expected[found.index[k]];
                    EXPECT_NEAR(found.x[k], r.x, 6e-7 * support); // cells of up to 1.5 supports
                    EXPECT_NEAR(found.y[k], r.y, 6e-7 * support);
                }
            }
        }
    }
}

/// A channel with a warm floor, a lid that moves, and a block whose left side is at `block`.
Config channel(double seam, double block) {
    Config config = closed(rectangle({seam, 0}, {seam + 1.2, 0.8}), spacing, false);
    config.walls = {
        {.name = "floor", .from = {seam, 0}, .to = {seam + 1.2, 0}, .temperature = 1.0},
        {.name = "lid", .from = {seam, 0.8}, .to = {seam + 1.2, 0.8}, .velocity = {3, 0}},
        {.name = "block", .temperature = 0.0, .around = 1}};
    config.holes = {moved(rectangle({0, 0.3}, {0.2, 0.5}), {block, 0})};
    config.periodic.x = true;
    config.thermal_expansion = 1;
    config.gravity = {-20, -100};
    config.reference_temperature = 0.5;
    config.initial_temperature = 0.5;
    return config;
}

TEST(FluidPeriodic, WallsAreTheSameAnywhereInThePeriod) {
    // The same scene with its seam beside the block, and five spacings away from it.
    const Config near = channel(0, 0.05), far = channel(-0.5, 0.05);
    Boundary beside(near, {}, {}), apart(far, {}, {});
    for (Boundary* boundary : {&beside, &apart}) {
        boundary->set_walls(0);
    }
    const Ghosts ghosts(spacing);
    WallSums one, other;
    std::vector<Contact> contacts;
    int blocked = 0;
    for (double y = 0.03; y < 0.8; y += 0.043) {
        for (double x = 0.011; x < 1.2; x += 0.037) {
            if (!beside.contains({x, y})) {
                EXPECT_FALSE(apart.contains(apart.grid().wrapped({x, y})));
                ++blocked;
                continue;
            }
            beside.contacts({x, y}, contacts);
            ghosts.sums(beside, contacts, one);
            const Vec2 place = apart.grid().wrapped({x, y});
            EXPECT_TRUE(apart.contains(place));
            EXPECT_NEAR(beside.distance({x, y}), apart.distance(place), 1e-14);
            EXPECT_NEAR(beside.nearest({x, y}).distance, apart.nearest(place).distance, 1e-14);
            apart.contacts(place, contacts);
            ghosts.sums(apart, contacts, other);
            EXPECT_NEAR(one.C.x, other.C.x, 1e-9 / spacing);
            EXPECT_NEAR(one.C.y, other.C.y, 1e-9 / spacing);
            EXPECT_NEAR(one.u.K, other.u.K, 1e-9 / (spacing * spacing));
            EXPECT_NEAR(one.temperature.K, other.temperature.K, 1e-9 / (spacing * spacing));
            EXPECT_NEAR(one.K_value[0], other.K_value[0], 3e-9 / (spacing * spacing));
            EXPECT_NEAR(one.K_value[3], other.K_value[3], 1e-9 / (spacing * spacing));
        }
    }
    EXPECT_GT(blocked, 10);
    EXPECT_NEAR(beside.area(), 1.2 * 0.8 - 0.04, 1e-12);
}

/// Particles by their first place in the period, in units of 1e-6 spacings.
std::map<std::pair<long, long>, std::size_t> by_place(const Fluid& fluid) {
    std::map<std::pair<long, long>, std::size_t> places;
    const Snapshot s = fluid.snapshot();
    for (std::size_t i = 0; i < s.position.size(); ++i) {
        const double x = s.position[i].x - 1.2 * std::floor(s.position[i].x / 1.2);
        places[{std::lround(x / spacing * 1e6), std::lround(s.position[i].y / spacing * 1e6)}] = i;
    }
    return places;
}

TEST(FluidPeriodic, TheFlowDoesNotKnowWhereTheSeamIs) {
    for (const Formulation formulation : {Formulation::consistent, Formulation::paper}) {
        Config near = channel(0, 0.1), far = channel(-0.5, 0.1);
        near.formulation = far.formulation = formulation;
        Fluid beside(near), apart(far);
        const auto twins = by_place(apart);
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (const auto& [place, i] : by_place(beside)) {
            ASSERT_EQ(twins.count(place), 1u);
            pairs.push_back({i, twins.at(place)});
        }
        beside.advance(0.01);
        apart.advance(0.01);
        const Snapshot one = beside.snapshot(), other = apart.snapshot();
        int over = 0;
        for (const auto& [i, j] : pairs) {
            EXPECT_GE(one.position[i].x, 0);
            EXPECT_LE(one.position[i].x, 1.2);
            const Vec2 way = one.position[i] - other.position[j];
            over += std::abs(way.x) > 0.6 ? 1 : 0;
            // Single precision in the operators, on other places in their cells.
            EXPECT_NEAR(way.x - 1.2 * std::round(way.x / 1.2), 0, 1e-6 * spacing);
            EXPECT_NEAR(way.y, 0, 1e-6 * spacing);
            EXPECT_NEAR(norm(one.velocity[i] - other.velocity[j]), 0, 1e-5);
            EXPECT_NEAR(one.temperature[i], other.temperature[j], 1e-6);
        }
        EXPECT_GT(over, 0);
        EXPECT_GT(beside.ledger().max_speed, 1);
        const Ledger l = beside.ledger();
        EXPECT_NEAR(l.heat_from_walls, apart.ledger().heat_from_walls, 1e-6);
        EXPECT_EQ(l.particles_outside, 0u);
        for (std::size_t w = 0; w < beside.walls().size(); ++w) {
            const Vec2 force = apart.walls()[w].force;
            EXPECT_LT(norm(beside.walls()[w].force - force), 2e-5 * (1 + norm(force)));
        }
        // On the seam, at either end of it, and beside it.
        for (const double y : {0.1, 0.6}) {
            EXPECT_NEAR(beside.at({0, y}).velocity.x, beside.at({1.2, y}).velocity.x, 1e-12);
            for (const double x : {0.0, 0.02, 0.6, 0.68}) {
                const double there = x < 0.69 ? x : x - 1.2;
                EXPECT_NEAR(beside.at({x, y}).velocity.x, apart.at({there, y}).velocity.x, 1e-5);
                EXPECT_NEAR(beside.at({x, y}).pressure, apart.at({there, y}).pressure, 1e-2);
            }
        }
    }
}

/// Eddies in a box without walls, blown by a wind that carries them over its sides.
Fluid eddies(int threads) {
    Config config = closed(rectangle({0, 0}, {1, 1}), 0.05, false);
    config.periodic = {true, true};
    config.kinematic_viscosity = 0.01;
    config.conductivity = 0.01;
    config.disorder = 0.1;
    config.thermal_expansion = 1;
    config.gravity = {3, -10};
    config.body_force = {0.5, -0.2};
    config.threads = threads;
    Fluid fluid(config);
    fluid.set_fields([](Vec2 x) {
        const double k = 2 * std::numbers::pi;
        return Values{
            std::sin(k * (x.x + x.y)), {1 + std::sin(k * x.y), -2 + std::cos(k * x.x)}, 0, {}};
    });
    return fluid;
}

TEST(FluidPeriodic, MassMomentumAndHeatAreKept) {
    Fluid fluid = eddies(1);
    const double before = fluid.ledger().mass;
    fluid.advance(0.2);
    fluid.advance(0.3);
    const Ledger l = fluid.ledger();
    EXPECT_EQ(l.mass, before);
    EXPECT_NEAR(l.mass, 1, 1e-14);
    // What the scheme itself would lose is far more than rounding.
    EXPECT_GT(l.closure_momentum_abs, 1e-6);
    EXPECT_LT(l.closure_momentum_abs, 1.15e-2);
    EXPECT_GT(norm(l.momentum), 0.1);
    EXPECT_NEAR(l.momentum.x, l.impulse_from_body_force.x, 1e-13);
    EXPECT_NEAR(l.momentum.y, l.impulse_from_body_force.y, 1e-13);
    EXPECT_NEAR(l.heat, 0, 1e-12);
    EXPECT_EQ(norm(l.impulse_from_walls), 0);
    EXPECT_EQ(l.particles_outside, 0u);
    const Snapshot s = fluid.snapshot();
    for (const Vec2 x : s.position) {
        EXPECT_TRUE(x.x >= 0 && x.x <= 1 && x.y >= 0 && x.y <= 1);
    }
}

TEST(FluidPeriodic, SameBitsForTwoThreadsAndAfterARestore) {
    Fluid one = eddies(1), two = eddies(2);
    one.advance(0.05);
    two.advance(0.05);
    const std::string saved = one.save();
    EXPECT_TRUE(two.save() == saved);
    one.advance(0.05);
    Fluid resumed = eddies(1);
    resumed.restore(saved);
    resumed.advance(0.05);
    EXPECT_TRUE(resumed.save() == one.save());
}

TEST(FluidPeriodic, ABodyThatDriftsWithTheFluidLeavesItAlone) {
    // Everything moves with (3, 2) m/s, through both periods and beyond.
    Config config = closed(rectangle({0, 0}, {1, 1}), spacing, false);
    config.periodic = {true, true};
    config.kinematic_viscosity = 0.1;
    const Vec2 wind{3, 2};
    std::vector<Chain> chains;
    InterfaceState now;
    square_body({0.4, 0.4}, 0.3, 3, chains, now);
    std::fill(now.velocity.begin(), now.velocity.end(), wind);
    Fluid fluid(config, chains, now);
    fluid.set_fields([&](Vec2) { return Values{0, wind, 0, {}}; });
    const double window = 0.02;
    for (int i = 0; i < 55; ++i) {
        InterfaceState next = now;
        for (Vec2& x : next.position) {
            x += window * wind;
        }
        fluid.advance(window, now, next);
        now = next;
        const Ledger l = fluid.ledger();
        ASSERT_EQ(l.particles_outside, 0u);
        ASSERT_EQ(l.wall_hits, 0u);
        ASSERT_NEAR(l.max_speed, norm(wind), 1e-4);
        for (const Vec2 impulse : fluid.passed().impulse) {
            ASSERT_NEAR(norm(impulse) / window, 0, 1e-2); // rho c U dx is 10 N/m
        }
        const Vec2 middle = 0.5 * (now.position[0] + now.position[6]);
        const Vec2 within{middle.x - std::floor(middle.x), middle.y - std::floor(middle.y)};
        ASSERT_TRUE(std::isnan(fluid.at(within).velocity.x));
    }
}

TEST(FluidPeriodic, TheLatticeFitsThePeriod) {
    // 6.7 and 7.6 spacings: seven and eight particles, as far apart over the seam as elsewhere.
    Config config = closed(rectangle({0, 0}, {0.67, 0.76}), spacing, false);
    config.periodic = {true, true};
    const Fluid fluid(config);
    ASSERT_EQ(fluid.size(), 56u);
    const Snapshot s = fluid.snapshot();
    for (std::size_t i = 0; i < 56; ++i) {
        EXPECT_NEAR(s.position[i].x, 0.67 / 7 * (static_cast<double>(i % 7) + 0.5), 1e-14);
        EXPECT_NEAR(s.position[i].y, 0.76 / 8 * (static_cast<double>(i / 7) + 0.5), 1e-14);
    }
}

TEST(FluidPeriodic, WhatCannotRepeatItselfIsRefused) {
    const auto expect_refused = [](const Config& config, const std::string& with) {
        try {
            Fluid fluid(config);
            ADD_FAILURE() << "not refused: " << with;
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find(with), std::string::npos) << error.what();
        }
    };
    const Config good = channel(0, 0.1);
    Config bad = good;
    bad.region = {{0, 0}, {1.2, 0}, {1.2, 0.8}, {0.1, 0.8}};
    bad.walls.clear();
    expect_refused(bad, "rectangle");
    bad = good;
    bad.spacing = 0.21;
    expect_refused(bad, "six spacings");
    bad = good;
    bad.walls.push_back({.name = "left", .from = {0, 0}, .to = {0, 0.8}});
    expect_refused(bad, "wall 'left'");
    bad = good;
    bad.holes = {rectangle({0, 0.3}, {0.2, 0.5})};
    expect_refused(bad, "a hole");
    std::vector<Chain> chains;
    InterfaceState state;
    square_body({1.05, 0.3}, 0.2, 2, chains, state);
    EXPECT_THROW(Fluid(good, chains, state), SceneError);
}

} // namespace
} // namespace duet::fluid::test
