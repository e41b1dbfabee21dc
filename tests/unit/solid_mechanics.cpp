#include "tests/unit/solid_support.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <numbers>

namespace duet::solid {
namespace {

using test::At;

constexpr double rounding = 1e-12; // of stresses of size 1 to 10

Eigen::Matrix2d in_plane(const PlaneTensor& s) {
    return (Eigen::Matrix2d() << s.xx, s.xy, s.xy, s.yy).finished();
}

/// Cauchy stress of St Venant-Kirchhoff at F without thermal strain.
Eigen::Matrix2d cauchy(const Material& m, const Eigen::Matrix2d& f) {
    const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d e = 0.5 * (f.transpose() * f - unit);
    const Eigen::Matrix2d s = m.lambda() * e.trace() * unit + 2 * m.mu() * e;
    return f * s * f.transpose() / f.determinant();
}

class Patch : public testing::TestWithParam<Smoothing> {};

TEST_P(Patch, LinearDisplacementGivesUniformStressAndNoInnerForce) {
    BodyConfig config = test::steel_like(test::distorted_square(6));
    config.smoothing = GetParam();
    Body body(config);
    const Eigen::Matrix2d f = (Eigen::Matrix2d() << 1.2, 0.3, -0.1, 0.9).finished();
    const auto u = test::nodal_vector(config.mesh, [&](const Point& p) { return f * p - p; });
    body.mechanics()->set_motion(u, std::vector<double>(u.size(), 0.0), body.temperature());
    const Eigen::Matrix2d expected = cauchy(config.material, f);
    for (std::size_t k = 0; k < body.domains().size(); ++k) {
        const auto stress = in_plane(body.mechanics()->domain_stress(k, body.temperature()));
        EXPECT_LT((stress - expected).cwiseAbs().maxCoeff(), rounding);
    }
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        if (!test::on_unit_square(config.mesh.node[i])) {
            EXPECT_NEAR(body.mechanics()->internal_force()[2 * i], 0, rounding);
            EXPECT_NEAR(body.mechanics()->internal_force()[2 * i + 1], 0, rounding);
        }
    }
}

TEST_P(Patch, UniformWarmingOfAConstrainedBody) {
    BodyConfig config = test::steel_like(test::distorted_square(6));
    config.smoothing = GetParam();
    config.initial_temperature = config.reference_temperature + 10;
    Body body(config);
    const double pressure = 10 * config.material.beta();
    for (std::size_t k = 0; k < body.domains().size(); ++k) {
        const PlaneTensor s = body.mechanics()->domain_stress(k, body.temperature());
        EXPECT_NEAR(s.xx, -pressure, rounding);
        EXPECT_NEAR(s.yy, -pressure, rounding);
        EXPECT_NEAR(s.zz, -pressure, rounding);
        EXPECT_NEAR(s.xy, 0, rounding);
        EXPECT_NEAR(s.von_mises(), 0, rounding);
    }
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        if (!test::on_unit_square(config.mesh.node[i])) {
            EXPECT_NEAR(body.mechanics()->internal_force()[2 * i], 0, rounding);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(SolidMechanics,
                         Patch,
                         testing::Values(Smoothing::edge, Smoothing::element));

TEST(SolidMechanics, RotationTurnsTheStressAndMakesNone) {
    const BodyConfig config = test::steel_like(test::distorted_square(5));
    Body body(config);
    const Eigen::Matrix2d stretch = (Eigen::Matrix2d() << 1.1, 0, 0, 1).finished();
    const Eigen::Matrix2d stress = cauchy(config.material, stretch);
    for (const double degrees : {30.0, 90.0, 200.0, 360.0}) {
        const Eigen::Matrix2d r =
            Eigen::Rotation2Dd(degrees * std::numbers::pi / 180).toRotationMatrix();
        for (const bool stretched : {false, true}) {
            const Eigen::Matrix2d f = stretched ? Eigen::Matrix2d(r * stretch) : r;
            const Eigen::Matrix2d expected =
                stretched ? Eigen::Matrix2d(r * stress * r.transpose()) : Eigen::Matrix2d::Zero();
            const auto u =
                test::nodal_vector(config.mesh, [&](const Point& p) { return f * p - p; });
            body.mechanics()->set_motion(u, std::vector<double>(u.size(), 0.0), body.temperature());
            for (std::size_t k = 0; k < body.domains().size(); ++k) {
                const auto s = in_plane(body.mechanics()->domain_stress(k, body.temperature()));
                EXPECT_LT((s - expected).cwiseAbs().maxCoeff(), rounding) << degrees;
            }
        }
    }
}

TEST(SolidMechanics, FreeBodyKeepsItsMomenta) {
    // Internal and damping forces sum to nothing and, total Lagrangian, turn nothing.
    BodyConfig config = test::steel_like(test::distorted_square(5));
    config.initial_velocity = {0.3, -0.2};
    config.stiffness_damping = 0.01;
    Body body(config);
    test::Noise noise;
    std::vector<double> u(2 * body.nodes());
    std::generate(u.begin(), u.end(), [&] { return 0.01 * noise(); });
    const auto v = test::nodal_vector(
        config.mesh, [&](const Point& p) { return Point(0.3 - 0.5 * p.y(), -0.2 + 0.5 * p.x()); });
    body.mechanics()->set_motion(u, v, body.temperature());
    const auto momenta = [&] {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < body.nodes(); ++i) {
            const double m = body.mechanics()->mass()[i];
            const double x = body.position()[2 * i], y = body.position()[2 * i + 1];
            const double vx = body.velocity()[2 * i], vy = body.velocity()[2 * i + 1];
            sum += m * Eigen::Vector3d(vx, vy, x * vy - y * vx);
        }
        return sum;
    };
    const Eigen::Vector3d before = momenta();
    body.advance(1);
    const Eigen::Vector3d after = momenta();
    EXPECT_LT((after - before).head<2>().norm(), 1e-12);
    // The damping stress is symmetric too, so the angular momentum keeps to the rounding.
    EXPECT_NEAR(after[2], before[2], 1e-12);
}

TEST(SolidMechanics, EnergyIsKeptWithoutDamping) {
    BodyConfig config = test::steel_like(test::distorted_square(5));
    config.material.thermal_expansion = 0;
    Body body(config);
    const auto u = test::nodal_vector(
        config.mesh, [&](const Point& p) { return Point(0.01 * p.x(), -0.004 * p.y()); });
    body.mechanics()->set_motion(u, std::vector<double>(u.size(), 0.0), body.temperature());
    const auto energy = [&] {
        return body.mechanics()->kinetic_energy() + body.mechanics()->strain_energy();
    };
    const double before = energy();
    const double step = 0.1 * body.stable_step();
    double drift = 0;
    for (int i = 0; i < 2000; ++i) {
        body.step(step);
        drift = std::max(drift, std::abs(energy() - before));
    }
    EXPECT_LT(drift, 0.01 * before); // oscillates by (w dt)^2/4 <= 0.01 and does not drift
}

TEST(SolidMechanics, MomentumIsTheImpulseOfALoadAndItsWorkIsBooked) {
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 1, 0.25));
    config.material.thermal_expansion = 0;
    Body body(config);
    std::vector<double> force(2 * body.nodes(), 0.0);
    force[2 * 12] = 0.02; // the middle node
    body.set_interface_load(std::vector<double>(body.nodes(), 0.0), force);
    body.advance(2);
    double momentum = 0;
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        momentum += body.mechanics()->mass()[i] * body.velocity()[2 * i];
    }
    EXPECT_NEAR(momentum, 0.04, 1e-14);
    const double energy = body.mechanics()->kinetic_energy() + body.mechanics()->strain_energy();
    EXPECT_NEAR(body.mechanics()->work().interface, energy, 0.02 * energy); // order (w dt)^2
}

TEST(SolidMechanics, HeldSidesStayAndTractionPulls) {
    // Uniaxial strain: clamped across, pulled along; damped to rest.
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 0.5, 0.125));
    config.material.thermal_expansion = 0;
    config.stiffness_damping = 0.2;
    config.boundary = {test::side(At::left, 1, 0.5),
                       test::side(At::bottom, 1, 0.5),
                       test::side(At::top, 1, 0.5),
                       test::side(At::right, 1, 0.5)};
    config.boundary[0].fixed_x = true;
    config.boundary[1].fixed_y = true;
    config.boundary[2].fixed_y = true;
    config.boundary[3].traction = {1e-4, 0};
    Body body(config);
    body.advance(40); // more than ten times the time in which the slowest mode is damped
    const double modulus = config.material.lambda() + 2 * config.material.mu();
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        const Point& p = config.mesh.node[i];
        EXPECT_NEAR(body.position()[2 * i] - p.x(), 1e-4 / modulus * p.x(), 1e-8); // its square
        EXPECT_NEAR(body.position()[2 * i + 1], p.y(), rounding);
    }
}

TEST(SolidMechanics, DeformableBodyNeedsYoungsModulus) {
    BodyConfig config = test::steel_like(test::distorted_square(3));
    config.material.youngs_modulus = 0;
    EXPECT_THROW(Body{config}, std::invalid_argument);
}

} // namespace
} // namespace duet::solid
