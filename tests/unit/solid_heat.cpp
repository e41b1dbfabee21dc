#include "tests/unit/solid_support.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace duet::solid {
namespace {

using test::At;

/// The conduction matrix as (26) reads, dense, straight from the triangles: the slow obvious twin.
Eigen::MatrixXd dense_conduction(const Mesh& mesh, double conductivity) {
    const auto n = static_cast<Eigen::Index>(mesh.node.size());
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
    for (const Edge& edge : mesh_edges(mesh)) {
        Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(2, n);
        double area = 0;
        for (const std::uint32_t e : edge.triangle) {
            if (e == Edge::none) {
                continue;
            }
            const Triangle& t = mesh.triangle[e];
            Eigen::Matrix3d corners; // rows 1, x, y; the shape functions are its inverse's rows
            for (int i = 0; i < 3; ++i) {
                corners.col(i) << 1, mesh.node[t[static_cast<std::size_t>(i)]];
            }
            const Eigen::Matrix3d shape = corners.inverse();
            const double third = triangle_area(mesh, t) / 3;
            area += third;
            for (int i = 0; i < 3; ++i) {
                gradient.col(t[static_cast<std::size_t>(i)]) +=
                    third * shape.row(i).tail<2>().transpose();
            }
        }
        k += conductivity / area * gradient.transpose() * gradient;
    }
    return k;
}

TEST(SolidConduction, AgreesWithTheDenseMatrix) {
    const Mesh mesh = test::distorted_square(5);
    const Conduction conduction(make_domains(mesh, Smoothing::edge), {0.7});
    const Eigen::MatrixXd dense = dense_conduction(mesh, 0.7);
    const auto n = static_cast<Eigen::Index>(mesh.node.size());
    test::Noise noise;
    const Eigen::VectorXd t = Eigen::VectorXd::NullaryExpr(n, [&] { return noise(); });
    const Eigen::VectorXd rate = Eigen::VectorXd::NullaryExpr(n, [&] { return noise(); });
    const Eigen::VectorXd factor = Eigen::VectorXd::NullaryExpr(n, [&] { return noise(); });
    Eigen::VectorXd out(n);
    conduction.advance(t.data(), rate.data(), factor.data(), out.data(), 0, mesh.node.size());
    const Eigen::VectorXd expected = t + factor.cwiseProduct(rate - dense * t);
    EXPECT_LT((out - expected).cwiseAbs().maxCoeff(), 1e-13); // rounding
}

TEST(SolidConduction, UniformTemperatureStaysToTheLastBit) {
    BodyConfig config = test::steel_like(test::distorted_square(5));
    config.motion = Motion::fixed;
    config.initial_temperature = 1234.567;
    Body body(config);
    body.advance(10);
    for (const double t : body.temperature()) {
        EXPECT_EQ(t, 1234.567);
    }
}

TEST(SolidConduction, LinearTemperatureIsSteady) {
    // Heat patch test: with T = a + b x + c y on the boundary the inner nodes feel no change.
    const Mesh mesh = test::distorted_square(6);
    const Domains domains = make_domains(mesh, Smoothing::edge);
    const Conduction conduction(domains, {2.5});
    std::vector<double> t, none(mesh.node.size(), 0.0), one(mesh.node.size(), 1.0);
    for (const Point& p : mesh.node) {
        t.push_back(3 + 2 * p.x() - 5 * p.y());
    }
    std::vector<double> out(t.size());
    conduction.advance(t.data(), none.data(), one.data(), out.data(), 0, t.size());
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (!test::on_unit_square(mesh.node[i])) {
            EXPECT_NEAR(out[i], t[i], 1e-13); // rounding
        }
    }
}

TEST(SolidHeat, StoredHeatIsAllThatCameIn) {
    BodyConfig config = test::steel_like(test::distorted_square(8));
    config.motion = Motion::fixed;
    config.initial_temperature = 400;
    config.heat_source = 3;
    config.boundary = {test::side(At::left), test::side(At::right), test::side(At::top)};
    config.boundary[0].heat_flux = 11;
    config.boundary[1].convection = Convection{2, 290};
    config.boundary[2].temperature = 350;
    Body body(config);
    std::vector<double> heat(body.nodes(), 0.0);
    heat[4] = -7; // a node of the bottom side
    body.set_interface_load(heat, {});
    body.advance(5);
    const HeatAccount& account = body.heat().account();
    EXPECT_NEAR(account.interface, -7 * 5, 1e-11);
    EXPECT_NEAR(account.sources, 3 * 5, 1e-11); // unit area
    EXPECT_LT(account.walls, 0);                // more is lost at 350 K and 290 K than comes in
    const double in = account.interface + account.sources + account.walls;
    EXPECT_NEAR(body.heat().stored(), in, 1e-11); // rounding: 2400 J held, some 1000 steps
}

TEST(SolidHeat, SteadyStateOfFluxAndConvection) {
    // One-dimensional: q in on the left, h (T - Tinf) out on the right, T = Tinf + q/h + q (1 -
    // x)/k.
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 0.2, 0.1));
    config.motion = Motion::fixed;
    config.boundary = {test::side(At::left, 1, 0.2), test::side(At::right, 1, 0.2)};
    config.boundary[0].heat_flux = 14;
    config.boundary[1].convection = Convection{7, 280};
    Body body(config);
    body.advance(200); // the slowest mode has decayed by exp(-20)
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        const double x = config.mesh.node[i].x();
        EXPECT_NEAR(body.temperature()[i], 282 + 20 * (1 - x), 1e-6);
    }
}

TEST(SolidHeat, BoundaryThatMatchesNothingIsRefused) {
    BodyConfig config = test::steel_like(test::distorted_square(3));
    config.boundary = {test::side(At::right, 2, 1)};
    config.boundary[0].heat_flux = 1;
    try {
        Body body(config);
        FAIL() << "accepted";
    } catch (const std::invalid_argument& fault) {
        EXPECT_NE(std::string(fault.what()).find("matches no edge"), std::string::npos);
    }
}

} // namespace
} // namespace duet::solid
