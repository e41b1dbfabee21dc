// How walls and interface chains join into closed loops.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

const std::vector<Vec2> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

InterfaceState at_rest(std::vector<Vec2> positions) {
    const std::size_t n = positions.size();
    return {std::move(positions), std::vector<Vec2>(n), std::vector<double>(n)};
}

TEST(FluidBoundary, EitherOrderOfTheCornersIsTheSameFluid) {
    const Boundary one(closed(square, 0.1, true), {}, {});
    const Boundary other(closed({square.rbegin(), square.rend()}, 0.1, true), {}, {});
    EXPECT_NEAR(one.area(), 1, 1e-15);
    EXPECT_NEAR(other.area(), 1, 1e-15);
    for (const Face& face : one.faces()) {
        EXPECT_GT(dot(face.normal, face.a - Vec2{0.5, 0.5}), 0) << "normals point out of the fluid";
    }
}

TEST(FluidBoundary, ABodyIsCutOut) {
    std::vector<Chain> chains;
    InterfaceState state;
    square_body({0.3, 0.3}, 0.4, 8, chains, state);
    const Boundary boundary(closed(square, 0.05, true), chains, state);
    EXPECT_NEAR(boundary.area(), 1 - 0.16, 1e-14);
    EXPECT_FALSE(boundary.contains({0.5, 0.5}));
    EXPECT_TRUE(boundary.contains({0.2, 0.5}));
    EXPECT_EQ(boundary.faces().size(), 8u); // its 32 segments make four faces
    EXPECT_GT(boundary.nearest({0.28, 0.5}).distance, 0);
    EXPECT_LT(boundary.nearest({0.32, 0.5}).distance, 0);
    EXPECT_GT(boundary.nearest({0.29, 0.28}).distance, 0) << "beside a corner";
    EXPECT_LT(boundary.nearest({0.31, 0.302}).distance, 0);
}

TEST(FluidBoundary, BesideASharpTipTheFartherLineDecides) {
    // A wedge of 30 degrees that points left: just off its tip, one side's line passes on the wrong
    // side of the point.
    const InterfaceState state = at_rest({{0.3, 0.5}, {0.7, 0.4}, {0.7, 0.6}});
    const Boundary boundary(closed(square, 0.1, true), {{{0, 1, 2}, true}}, state);
    for (const double step : {0.01, -0.01}) {
        const auto nearest = boundary.nearest({0.29, 0.5 + step});
        ASSERT_NE(nearest.face, nullptr);
        EXPECT_EQ(nearest.point, (Vec2{0.3, 0.5}));
        EXPECT_GT(nearest.distance, 0);
    }
    EXPECT_LT(boundary.nearest({0.32, 0.5}).distance, 0);
}

TEST(FluidBoundary, ALeaningBodyReplacesTheWallItCovers) {
    // It stands on the bottom from 0.4 to 0.6, 0.5 high: its wet chain runs over its sides and top,
    // fluid to the right.
    const InterfaceState state = at_rest({{0.6, 0}, {0.6, 0.5}, {0.4, 0.5}, {0.4, 0}});
    Config config = closed(square, 0.05, true);
    const Boundary boundary(config, {{{0, 1, 2, 3}, false}}, state);
    EXPECT_NEAR(boundary.area(), 0.9, 1e-14);
    EXPECT_FALSE(boundary.contains({0.5, 0.25}));
    EXPECT_TRUE(boundary.contains({0.5, 0.75}));
    EXPECT_NEAR(boundary.wall_length()[0], 0.8, 1e-14) << "the bottom";
    EXPECT_NEAR(boundary.wall_length()[1], 1, 1e-14);
}

TEST(FluidBoundary, ABodyThatCoversAWholeSide) {
    const InterfaceState state = at_rest({{1, 1}, {1, 0.5}, {1, 0}});
    const Boundary boundary(closed(square, 0.05, true), {{{0, 1, 2}, false}}, state);
    EXPECT_NEAR(boundary.area(), 1, 1e-14);
    EXPECT_NEAR(boundary.wall_length()[1], 0, 1e-14);
    EXPECT_NEAR(boundary.wall_length()[0], 1, 1e-14);
}

TEST(FluidBoundary, ABandDividesTheFluid) {
    // Between x = 0.4 and 0.6 from bottom to top.
    const InterfaceState state = at_rest({{0.4, 1}, {0.4, 0}, {0.6, 0}, {0.6, 1}});
    const std::vector<Chain> chains{{{0, 1}, false}, {{2, 3}, false}};
    const Boundary boundary(closed(square, 0.05, true), chains, state);
    EXPECT_NEAR(boundary.area(), 0.8, 1e-14);
    EXPECT_FALSE(boundary.contains({0.5, 0.5}));
    EXPECT_TRUE(boundary.contains({0.3, 0.5}));
    EXPECT_TRUE(boundary.contains({0.7, 0.5}));
}

TEST(FluidBoundary, MisfitsAreRefusedWithASentence) {
    const auto message = [](const auto& build) {
        try {
            build();
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string("nothing was thrown");
    };
    const std::string open = message([] {
        Boundary(closed(square, 0.05, true), {{{0, 1}, false}}, at_rest({{0.6, 0}, {0.6, 0.5}}));
    });
    EXPECT_NE(open.find("(0.600000, 0.500000)"), std::string::npos) << open;
    const std::string wall = message([] {
        Config config = closed(square, 0.05, true);
        config.walls.push_back({"lid", {0.2, 1}, {0.8, 1}, 0.0, {}});
        Boundary(config, {}, {});
    });
    EXPECT_NE(wall.find("'lid'"), std::string::npos) << wall;
    const std::string overlap = message([] {
        Boundary(closed(square, 0.05, true),
                 {{{0, 1}, false}, {{2, 3}, false}},
                 at_rest({{0.6, 0}, {0.6, 1}, {0.7, 0}, {0.7, 1}}));
    });
    EXPECT_NE(overlap.find("overlap"), std::string::npos) << overlap;
}

TEST(FluidBoundary, ValuesAreLinearAlongTheInterface) {
    std::vector<Chain> chains;
    InterfaceState state;
    square_body({0.3, 0.3}, 0.4, 8, chains, state);
    Boundary boundary(closed(square, 0.05, true), chains, state);
    set_walls(
        boundary,
        [](Vec2 x) { return x.x; },
        [](Vec2 x) { return x.y; },
        [](Vec2 x) { return 2 + 3 * x.x - x.y; });
    for (const Face& face : boundary.faces()) {
        for (double arc = 0; arc <= face.length; arc += 0.0137) {
            const Vec2 x = face.a + arc * face.tangent;
            const WallPoint point = boundary.at(face, arc);
            EXPECT_NEAR(point.value[0], x.x, 1e-13);
            EXPECT_NEAR(point.value[3], 2 + 3 * x.x - x.y, 1e-13);
        }
    }
}

} // namespace
} // namespace duet::fluid::test
