#include "solid_solver/interface.hpp"
#include "solid_solver/shapes.hpp"
#include "solid_solver/solid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace duet::solid {
namespace {

const std::vector<Point> cavity{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

Interface interface_of(const std::vector<Mesh>& meshes, const std::vector<Point>& region = cavity) {
    std::vector<BodyShape> shapes;
    for (const Mesh& mesh : meshes) {
        shapes.push_back({"body" + std::to_string(shapes.size()), &mesh, mesh.node});
    }
    return wet_interface(shapes, region);
}

std::string refusal(const std::vector<Mesh>& meshes, const std::vector<Point>& region = cavity) {
    try {
        interface_of(meshes, region);
    } catch (const std::invalid_argument& fault) {
        return fault.what();
    }
    return "";
}

/// The points one step to the right of each segment's middle lie in the fluid, those to the left in
/// the body.
void expect_fluid_on_the_right(const Interface& interface,
                               const Mesh& mesh,
                               const Point& low,
                               const Point& high) {
    for (const Interface::Segment& segment : interface.segment) {
        const Point a = mesh.node[interface.node[segment.a].node];
        const Point b = mesh.node[interface.node[segment.b].node];
        const Point right = 0.5 * (a + b) + 0.1 * Point(b.y() - a.y(), a.x() - b.x());
        const bool in_body = (right - low).minCoeff() > 0 && (high - right).minCoeff() > 0;
        EXPECT_FALSE(in_body);
    }
}

TEST(SolidInterface, ImmersedBodyHasOneClosedChain) {
    const Mesh mesh = rectangle_mesh({3, 3}, 4, 4, 0.5);
    const Interface interface = interface_of({mesh});
    ASSERT_EQ(interface.chain.size(), 1u);
    EXPECT_TRUE(interface.chain[0].closed);
    EXPECT_EQ(interface.node.size(), 32u);
    EXPECT_EQ(interface.segment.size(), 32u);
    EXPECT_EQ(interface.segment.back().b, 0u);
    double twice_area = 0;
    for (const Interface::Segment& segment : interface.segment) {
        const Point a = mesh.node[interface.node[segment.a].node];
        const Point b = mesh.node[interface.node[segment.b].node];
        twice_area += a.x() * b.y() - a.y() * b.x();
    }
    EXPECT_NEAR(twice_area, 32, 1e-12); // counter-clockwise
    expect_fluid_on_the_right(interface, mesh, {3, 3}, {7, 7});
}

TEST(SolidInterface, LeaningBodyHasOneOpenChainFromWallToWall) {
    const Mesh mesh = rectangle_mesh({0, 4}, 3, 2, 0.5); // leans on the left wall
    const Interface interface = interface_of({mesh});
    ASSERT_EQ(interface.chain.size(), 1u);
    EXPECT_FALSE(interface.chain[0].closed);
    EXPECT_EQ(interface.segment.size(), 6u + 4 + 6);
    EXPECT_EQ(interface.node.size(), interface.segment.size() + 1);
    EXPECT_EQ(mesh.node[interface.node.front().node], Point(0, 4));
    EXPECT_EQ(mesh.node[interface.node.back().node], Point(0, 6));
    expect_fluid_on_the_right(interface, mesh, {0, 4}, {3, 6});
}

TEST(SolidInterface, BodyInACornerAndBodyThatDivides) {
    const Mesh corner = rectangle_mesh({0, 0}, 2, 1, 0.5);
    const Interface in_corner = interface_of({corner});
    ASSERT_EQ(in_corner.chain.size(), 1u);
    EXPECT_EQ(in_corner.segment.size(), 2u + 4);

    const Mesh wall = rectangle_mesh({4, 0}, 1, 10, 0.5);
    const Interface dividing = interface_of({wall});
    ASSERT_EQ(dividing.chain.size(), 2u);
    for (const Interface::Chain& chain : dividing.chain) {
        EXPECT_FALSE(chain.closed);
        EXPECT_EQ(chain.segments(), 20u);
    }
    expect_fluid_on_the_right(dividing, wall, {4, 0}, {5, 10});
}

TEST(SolidInterface, BodyThatFillsTheRegionIsDry) {
    EXPECT_TRUE(interface_of({rectangle_mesh({0, 0}, 10, 10, 1)}).node.empty());
}

TEST(SolidInterface, NodesAreNumberedChainByChain) {
    const Interface interface =
        interface_of({rectangle_mesh({1, 1}, 1, 1, 0.5), rectangle_mesh({6, 6}, 2, 1, 0.5)});
    ASSERT_EQ(interface.chain.size(), 2u);
    std::uint32_t expected = 0;
    for (std::uint32_t c = 0; c < 2; ++c) {
        for (const std::uint32_t node : interface.chain[c].node) {
            EXPECT_EQ(node, expected++);
            EXPECT_EQ(interface.node[node].body, c);
        }
    }
}

TEST(SolidInterface, NonConvexRegion) {
    const std::vector<Point> step{{0, 0}, {10, 0}, {10, 10}, {5, 10}, {5, 5}, {0, 5}};
    const Interface on_step = interface_of({rectangle_mesh({6, 2}, 2, 2, 0.5)}, step);
    EXPECT_TRUE(on_step.chain.at(0).closed);
    EXPECT_NE(refusal({rectangle_mesh({2, 6}, 2, 2, 0.5)}, step).find("leaves"), std::string::npos);
    // All nodes and edges' middles lie inside, but the notch cuts through.
    const std::vector<Point> notch{
        {0, 0}, {10, 0}, {10, 10}, {5.3, 10}, {5.2, 2}, {5.1, 10}, {0, 10}};
    EXPECT_NE(refusal({rectangle_mesh({4, 4}, 2, 2, 1)}, notch), "");
}

TEST(SolidInterface, BodiesCountWhereTheyStart) {
    BodyConfig body;
    body.name = "paddle";
    body.mesh = rectangle_mesh({0, 4}, 3, 2, 0.5); // leans on the left wall until it is moved
    body.motion = Motion::prescribed;
    body.rigid_motion.displacement = Point(2, 0);
    EXPECT_TRUE(Solid({body}, cavity).interface().chain.at(0).closed);
    body.rigid_motion.displacement = Point(8, 0);
    EXPECT_THROW(Solid({body}, cavity), std::invalid_argument);
    body.motion = Motion::deformable;
    body.material.youngs_modulus = 1;
    body.initial_displacement = Point(7, 0); // against the right wall
    const Interface moved = Solid({body}, cavity).interface();
    EXPECT_EQ(moved.segment.size(), 6u + 4 + 6);
    EXPECT_EQ(body.mesh.node[moved.node.front().node], Point(3, 6));
}

TEST(SolidInterface, EachFaultIsNamed) {
    EXPECT_NE(refusal({rectangle_mesh({8, 8}, 4, 1, 0.5)}).find("leaves"), std::string::npos);
    const Mesh one = rectangle_mesh({2, 2}, 2, 2, 0.5);
    EXPECT_NE(refusal({one, rectangle_mesh({3, 3}, 2, 2, 0.5)}).find("overlap"), std::string::npos);
    EXPECT_NE(refusal({one, rectangle_mesh({4, 2}, 2, 2, 0.5)}).find("touch"), std::string::npos);
    EXPECT_NE(refusal({one, rectangle_mesh({1, 1}, 5, 5, 0.5)}).find("overlap"), std::string::npos);
    EXPECT_NE(refusal({rectangle_mesh({1, 1}, 5, 5, 0.5), one}).find("overlap"), std::string::npos);
    // A cross of single cells: no node of one lies in the other.
    EXPECT_NE(refusal({rectangle_mesh({1, 4}, 8, 1, 8), rectangle_mesh({4, 1}, 1, 8, 8)}), "");
    // The wall's corner lies inside an edge.
    const std::vector<Point> step{{0, 0}, {10, 0}, {10, 10}, {5, 10}, {5, 5}, {0, 5}};
    EXPECT_NE(refusal({rectangle_mesh({4.2, 3}, 3, 2, 1.5)}, step).find("lies inside an edge"),
              std::string::npos);
}

} // namespace
} // namespace duet::solid
