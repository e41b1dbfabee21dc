#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

namespace duet::solid {
namespace {

Mesh two_triangles() {
    return {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
}

std::string refusal(const Mesh& mesh) {
    try {
        check_mesh(mesh);
    } catch (const std::invalid_argument& fault) {
        return fault.what();
    }
    return "";
}

TEST(SolidMesh, RectangleHasTheRightSizes) {
    const Mesh mesh = rectangle_mesh({3, 3}, 4, 2, 0.05);
    EXPECT_EQ(mesh.node.size(), 81u * 41u);
    EXPECT_EQ(mesh.triangle.size(), 2u * 80 * 40);
    EXPECT_NEAR(mesh_area(mesh), 8, 1e-12); // rounding of 6400 terms
    EXPECT_EQ(mesh.node.back(), Point(7, 5));
    EXPECT_EQ(boundary_edges(mesh).size(), 2u * (80 + 40));
    EXPECT_EQ(refusal(mesh), "");
    EXPECT_EQ(refusal(rectangle_mesh({0, 0}, 1, 1, 1.0 / 3)), "");
}

TEST(SolidMesh, ElementSizeIsRoundedToWholeCells) {
    EXPECT_EQ(rectangle_mesh({0, 0}, 1, 1, 0.3).triangle.size(), 2u * 3 * 3);
    EXPECT_EQ(rectangle_mesh({0, 0}, 1, 1, 7).triangle.size(), 2u);
    EXPECT_THROW(rectangle_mesh({0, 0}, 1, -1, 0.1), std::invalid_argument);
}

TEST(SolidMesh, RectangleIsItsOwnMirrorImage) {
    // A preferred diagonal would make a symmetric problem lean to one side.
    const Mesh mesh = rectangle_mesh({-1, -1}, 2, 2, 0.5);
    std::vector<double> left, right;
    for (const Triangle& t : mesh.triangle) {
        const Point c = (mesh.node[t[0]] + mesh.node[t[1]] + mesh.node[t[2]]) / 3;
        (c.x() < 0 ? left : right).push_back(std::abs(c.x()) + 10 * c.y());
    }
    std::sort(left.begin(), left.end());
    std::sort(right.begin(), right.end());
    ASSERT_EQ(left.size(), right.size());
    for (std::size_t i = 0; i < left.size(); ++i) {
        EXPECT_NEAR(left[i], right[i], 1e-14);
    }
}

TEST(SolidMesh, BoundaryRunsRoundTheBodyWithItOnTheLeft) {
    const Mesh mesh = test::distorted_square(5);
    double twice_area = 0;
    for (const Edge& edge : boundary_edges(mesh)) {
        const Point &a = mesh.node[edge.a], &b = mesh.node[edge.b];
        twice_area += a.x() * b.y() - a.y() * b.x();
    }
    EXPECT_NEAR(twice_area, 2, 1e-14);
}

TEST(SolidMesh, EachFaultIsNamed) {
    EXPECT_EQ(refusal(two_triangles()), "");
    Mesh mesh = two_triangles();
    mesh.triangle[0] = {0, 2, 1};
    EXPECT_NE(refusal(mesh).find("inverted"), std::string::npos);
    mesh = two_triangles();
    mesh.triangle[0] = {0, 1, 9};
    EXPECT_NE(refusal(mesh).find("only 4 nodes"), std::string::npos);
    mesh = two_triangles();
    mesh.node.push_back({5, 5});
    EXPECT_NE(refusal(mesh).find("belongs to no triangle"), std::string::npos);
    mesh = two_triangles();
    mesh.node[3].y() = std::nan("");
    EXPECT_NE(refusal(mesh), "");
    mesh = two_triangles();
    mesh.node.push_back({0, 0});
    mesh.triangle[1][0] = 4; // the same corner under another number
    EXPECT_NE(refusal(mesh).find("same place"), std::string::npos);
    mesh = two_triangles();
    mesh.triangle.push_back({0, 1, 2});
    EXPECT_NE(refusal(mesh).find("same side"), std::string::npos);
    EXPECT_NE(refusal({}).find("no triangles"), std::string::npos);
}

/// Two meshes in one, without a common node.
std::string both(Mesh mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.node.size());
    mesh.node.insert(mesh.node.end(), other.node.begin(), other.node.end());
    for (const Triangle& t : other.triangle) {
        mesh.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return refusal(mesh);
}

TEST(SolidMesh, PiecesThatTouchWithoutCommonNodesAreRefused) {
    // As a mesh file has them whose surfaces were not joined: the boundary that the fluid sees
    // would be cut in two at the seam.
    const Mesh unit = rectangle_mesh({0, 0}, 1, 1, 0.5);
    EXPECT_NE(both(unit, rectangle_mesh({1, 0}, 1, 1, 0.5)).find("merge them"), std::string::npos);
    EXPECT_NE(both(unit, rectangle_mesh({1, 0.2}, 1, 0.2, 0.2)).find("hangs"), std::string::npos);
    EXPECT_NE(both(rectangle_mesh({1, 0.2}, 1, 0.2, 0.2), unit).find("hangs"), std::string::npos);
}

TEST(SolidMesh, PiecesThatOverlapAreRefused) {
    // Side by side, across each other, one within the other, and one with a corner on the other's
    // diagonal.
    const Mesh unit = rectangle_mesh({0, 0}, 1, 1, 1);
    EXPECT_EQ(both(unit, rectangle_mesh({1.5, 0}, 1, 1, 0.5)), "");
    for (const Mesh& other : {rectangle_mesh({0.3, 0.45}, 1, 1, 0.5),
                              rectangle_mesh({-0.5, 0.2}, 2, 0.3, 2),
                              rectangle_mesh({0.3, 0.45}, 0.1, 0.1, 0.1),
                              rectangle_mesh({-1.3, -2.1}, 4, 4, 1),
                              rectangle_mesh({0.5, 0.5}, 0.25, 0.25, 0.25)}) {
        EXPECT_NE(both(unit, other).find("overlap"), std::string::npos) << both(unit, other);
        EXPECT_NE(both(other, unit).find("overlap"), std::string::npos) << both(other, unit);
    }
}

TEST(SolidMesh, HangingNodesAndTouchingCornersAreRefused) {
    // The lower triangle has the whole side, the upper two have a half each.
    const Mesh hanging{{{0, 0}, {2, 0}, {1, 0}, {1, 1}, {1, -1}},
                       {{0, 2, 3}, {2, 1, 3}, {4, 1, 0}}};
    EXPECT_NE(refusal(hanging).find("hangs"), std::string::npos);
    const Mesh touching{{{0, 0}, {1, 0}, {1, 1}, {-1, 0}, {-1, -1}}, {{0, 1, 2}, {0, 3, 4}}};
    EXPECT_NE(refusal(touching).find("meets itself"), std::string::npos);
}

} // namespace
} // namespace duet::solid
