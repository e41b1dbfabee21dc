#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

namespace duet::solid {
namespace {

constexpr double rounding = 1e-12; // of gradients of size 10, from coordinates of size 1

double shape_at_centroid(const Triangle& triangle, std::uint32_t node) {
    return triangle[0] == node || triangle[1] == node || triangle[2] == node ? 1.0 / 3 : 0;
}

/// (15) as it stands: the contour integral of N_I n over the boundary of the domain, over its area.
/// Along each of its straight sides N_I is linear, so that the mean of its ends is exact.
Point contour_gradient(const Mesh& mesh, const Edge& edge, double area, std::uint32_t node) {
    struct Corner {
        Point place;
        double shape;
    };
    const auto centroid = [&](std::uint32_t e) {
        const Triangle& t = mesh.triangle[e];
        return Corner{(mesh.node[t[0]] + mesh.node[t[1]] + mesh.node[t[2]]) / 3,
                      shape_at_centroid(t, node)};
    };
    std::vector<Corner> corners{{mesh.node[edge.a], node == edge.a ? 1.0 : 0.0}};
    if (!edge.boundary()) {
        corners.push_back(centroid(edge.triangle[1]));
    }
    corners.push_back({mesh.node[edge.b], node == edge.b ? 1.0 : 0.0});
    corners.push_back(centroid(edge.triangle[0]));
    Point integral = Point::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Corner &from = corners[i], &to = corners[(i + 1) % corners.size()];
        const Point along = to.place - from.place;
        integral += 0.5 * (from.shape + to.shape) * Point(along.y(), -along.x());
    }
    return integral / area;
}

TEST(SolidSmoothing, AreaWeightedMeanIsTheContourIntegral) {
    const Mesh mesh = test::distorted_square(6);
    const Domains domains = make_domains(mesh, Smoothing::edge);
    const std::vector<Edge> edges = mesh_edges(mesh);
    ASSERT_EQ(domains.size(), edges.size());
    for (std::size_t k = 0; k < domains.size(); ++k) {
        for (std::size_t s = 0; s < (edges[k].boundary() ? 3u : 4u); ++s) {
            const Point expected =
                contour_gradient(mesh, edges[k], domains.area[k], domains.node[k][s]);
            EXPECT_NEAR(domains.gradient_x[k][s], expected.x(), rounding);
            EXPECT_NEAR(domains.gradient_y[k][s], expected.y(), rounding);
        }
    }
}

class Domain : public testing::TestWithParam<Smoothing> {};

TEST_P(Domain, AreasCoverTheBodyAndLinearFieldsAreExact) {
    const Mesh mesh = test::distorted_square(6);
    const Domains domains = make_domains(mesh, GetParam());
    double area = 0, integral = 0;
    for (std::size_t k = 0; k < domains.size(); ++k) {
        double gx = 0, gy = 0, mean = 0;
        for (std::size_t s = 0; s < Domains::slots; ++s) {
            const Point& p = mesh.node[domains.node[k][s]];
            const double f = 1 + 2 * p.x() - 3 * p.y();
            gx += domains.gradient_x[k][s] * f;
            gy += domains.gradient_y[k][s] * f;
            mean += domains.weight[k][s] * f;
        }
        EXPECT_NEAR(gx, 2, rounding);
        EXPECT_NEAR(gy, -3, rounding);
        area += domains.area[k];
        integral += domains.area[k] * mean;
    }
    EXPECT_NEAR(area, 1, rounding);
    EXPECT_NEAR(integral, 0.5, rounding); // of 1 + 2 x - 3 y over the unit square
}

TEST_P(Domain, WeightsGiveEachNodeItsLumpedArea) {
    // sum_k A_k weight_Ik = integral of N_I: what makes lumped heat and thermo-elastic work meet.
    const Mesh mesh = test::distorted_square(4);
    const Domains domains = make_domains(mesh, GetParam());
    const std::vector<double> area = nodal_area(mesh);
    for (std::size_t i = 0; i < area.size(); ++i) {
        double sum = 0;
        for (std::uint32_t e = domains.first[i]; e < domains.first[i + 1]; ++e) {
            const std::size_t k = domains.entry[e] / Domains::slots;
            EXPECT_EQ(domains.node[k][domains.entry[e] % Domains::slots], i);
            sum += domains.area[k] * domains.weight[k][domains.entry[e] % Domains::slots];
        }
        EXPECT_NEAR(sum, area[i], rounding);
    }
}

INSTANTIATE_TEST_SUITE_P(SolidSmoothing,
                         Domain,
                         testing::Values(Smoothing::edge, Smoothing::element));

TEST(SolidSmoothing, DomainMeanIsTheMeanOverItsSubTriangles) {
    const Mesh mesh{{{0, 0}, {2, 0}, {0.5, 1.5}}, {{0, 1, 2}}};
    const Domains domains = make_domains(mesh, Smoothing::edge);
    const Point centroid = (mesh.node[0] + mesh.node[1] + mesh.node[2]) / 3;
    const auto edges = mesh_edges(mesh);
    for (std::size_t k = 0; k < 3; ++k) {
        // The mean of a linear field over a triangle is its value in the middle.
        const Point middle = (mesh.node[edges[k].a] + mesh.node[edges[k].b] + centroid) / 3;
        double x = 0, y = 0;
        for (std::size_t s = 0; s < 3; ++s) {
            x += domains.weight[k][s] * mesh.node[domains.node[k][s]].x();
            y += domains.weight[k][s] * mesh.node[domains.node[k][s]].y();
        }
        EXPECT_NEAR(x, middle.x(), rounding);
        EXPECT_NEAR(y, middle.y(), rounding);
    }
}

} // namespace
} // namespace duet::solid
