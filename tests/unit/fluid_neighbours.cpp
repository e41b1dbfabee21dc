// The cell search against all pairs, and the sort.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

#include <set>

namespace duet::fluid::test {
namespace {

Particles random_cloud(std::size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0, 1);
    Particles particles;
    particles.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        particles.x[i] = place(random);
        particles.y[i] = place(random);
        particles.identity[i] = static_cast<std::uint32_t>(i);
    }
    return particles;
}

TEST(FluidNeighbours, EqualAllPairs) {
    const double support = 0.1;
    const CellGrid grid({0, 0}, {1, 1}, support);
    Particles particles = random_cloud(600);
    particles.sort(grid);
    Neighbours found;
    for (std::size_t a = 0; a < particles.size(); ++a) {
        ASSERT_TRUE(find_neighbours(particles, grid, support, a, found));
        std::set<std::uint32_t> expected, got;
        for (std::uint32_t b = 0; b < particles.size(); ++b) {
            if (b != a && norm(particles.position(a) - particles.position(b)) < support) {
                expected.insert(b);
            }
        }
        for (int i = 0; i < found.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            got.insert(found.index[k]);
            const Vec2 r = particles.position(a) - particles.position(found.index[k]);
            EXPECT_EQ(found.x[k], r.x);
            EXPECT_EQ(found.y[k], r.y);
            EXPECT_NEAR(found.r2[k], dot(r, r), 1e-15);
        }
        EXPECT_EQ(got, expected) << "particle " << a;
        EXPECT_EQ(static_cast<std::size_t>(found.count), expected.size());
    }
}

TEST(FluidNeighbours, TooManyAreRefused) {
    const CellGrid grid({0, 0}, {1, 1}, 0.5);
    Particles particles = random_cloud(600);
    particles.sort(grid);
    Neighbours found;
    EXPECT_FALSE(find_neighbours(particles, grid, 0.5, 0, found));
}

TEST(FluidNeighbours, SortKeepsTheOrderWithinACell) {
    const CellGrid grid({0, 0}, {1, 1}, 0.25);
    Particles particles = random_cloud(300);
    particles.sort(grid);
    for (std::size_t a = 1; a < particles.size(); ++a) {
        const std::size_t before = grid.index(particles.position(a - 1));
        const std::size_t cell = grid.index(particles.position(a));
        EXPECT_LE(before, cell);
        if (before == cell) {
            EXPECT_LT(particles.identity[a - 1], particles.identity[a]);
        }
    }
    for (std::size_t c = 0; c < grid.size(); ++c) {
        for (std::uint32_t a = particles.cell_start()[c]; a < particles.cell_start()[c + 1]; ++a) {
            EXPECT_EQ(grid.index(particles.position(a)), c);
        }
    }
}

} // namespace
} // namespace duet::fluid::test
