// The cell search against all pairs, and the sort.

#include "fluid_support.hpp"

#include "fluid_solver/chunks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

bool find(const Particles& particles,
          const CellGrid& grid,
          float support,
          std::size_t a,
          Neighbours& found) {
    static Surroundings surroundings;
    const Vec2 x = particles.position(a);
    return surroundings.collect(particles, grid, grid.column(x.x), grid.row(x.y))
           && surroundings.find(x, support, found);
}

TEST(FluidNeighbours, EqualAllPairs) {
    const float support = 0.1F;
    const CellGrid grid({0, 0}, {1, 1}, support);
    Particles particles = random_cloud(600);
    particles.sort(grid);
    Neighbours found;
    for (std::size_t a = 0; a < particles.size(); ++a) {
        ASSERT_TRUE(find(particles, grid, support, a, found));
        std::set<std::uint32_t> expected, got;
        for (std::uint32_t b = 0; b < particles.size(); ++b) {
            if (b != a && norm(particles.position(a) - particles.position(b)) < support) {
                expected.insert(b);
            }
        }
        for (std::size_t k = 0; k < found.count; ++k) {
            got.insert(found.index[k]);
            const Vec2 r = particles.position(a) - particles.position(found.index[k]);
            EXPECT_NEAR(found.x[k], r.x, 3e-7 * support); // places relative to the cell, as floats
            EXPECT_NEAR(found.y[k], r.y, 3e-7 * support);
        }
        EXPECT_EQ(got, expected) << "particle " << a;
        EXPECT_EQ(found.count, expected.size());
    }
}

#ifdef __AVX2__
TEST(FluidNeighbours, EightAtATimeAreThoseOneByOne) {
    const float support = 0.1F;
    const CellGrid grid({0, 0}, {1, 1}, support);
    Particles particles = random_cloud(900);
    particles.sort(grid);
    static Surroundings surroundings;
    Neighbours packed, plain;
    for (std::size_t a = 0; a < particles.size(); ++a) {
        const Vec2 x = particles.position(a);
        ASSERT_TRUE(surroundings.collect(particles, grid, grid.column(x.x), grid.row(x.y)));
        ASSERT_TRUE(surroundings.find_packed(x, support, packed));
        ASSERT_TRUE(surroundings.find_plainly(x, support, plain));
        ASSERT_EQ(packed.count, plain.count);
        for (std::size_t k = 0; k < plain.count; ++k) {
            EXPECT_EQ(packed.index[k], plain.index[k]);
            EXPECT_EQ(packed.x[k], plain.x[k]);
            EXPECT_EQ(packed.y[k], plain.y[k]);
        }
    }
}
#endif

TEST(FluidNeighbours, TooManyAreRefused) {
    const CellGrid grid({0, 0}, {1, 1}, 0.5);
    Neighbours found;
    Particles few = random_cloud(180); // all within reach of the surroundings, 64 too close
    few.sort(grid);
    std::size_t middle = 0;
    while (norm(few.position(middle) - Vec2{0.5, 0.5}) > 0.1) {
        ++middle;
    }
    EXPECT_FALSE(find(few, grid, 0.5F, middle, found));
    Particles many = random_cloud(600);
    many.sort(grid);
    EXPECT_FALSE(find(many, grid, 0.1F, 0, found));
}

/// With a thread for each range, and with more threads than ranges.
class FluidSort : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, FluidSort, testing::Values(1, 2, 3, 20));

TEST_P(FluidSort, KeepsTheOrderWithinACell) {
    const CellGrid grid({0, 0}, {1, 1}, 0.25);
    const Particles given = random_cloud(300);
    Particles particles = given;
    particles.sort(grid, GetParam());
    std::set<std::uint32_t> identities(particles.identity.begin(), particles.identity.end());
    EXPECT_EQ(identities.size(), given.size());
    for (std::size_t a = 0; a < particles.size(); ++a) {
        EXPECT_EQ(particles.x[a], given.x[particles.identity[a]]);
        EXPECT_EQ(particles.y[a], given.y[particles.identity[a]]);
    }
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

/// Each chunk once, in pieces that end where the particles end, whoever has it.
TEST_P(FluidSort, EveryChunkIsVisitedOnce) {
    for (const std::size_t n : {0, 1, 128, 129, 300, 128 * 37}) {
        std::vector<int> visits(n, 0);
        for_chunks(n, GetParam(), [&](std::size_t c, std::size_t first, std::size_t last) {
            EXPECT_EQ(first, c * chunk_size);
            EXPECT_LE(last - first, chunk_size);
            for (std::size_t a = first; a < last; ++a) {
                ++visits[a];
            }
        });
        EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), static_cast<long>(n)) << n;
    }
}

} // namespace
} // namespace duet::fluid::test
