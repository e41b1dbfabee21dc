// The updated Lagrangian description: rotation, shear, patch, relaxation.

#include "tests/unit/solid_support.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <numbers>

namespace duet::solid {
namespace {

using test::At;

constexpr double rounding = 1e-12; // of stresses of size 1 to 10

BodyConfig updated(Mesh mesh) {
    BodyConfig config = test::steel_like(std::move(mesh));
    config.kinematics = Kinematics::updated_lagrangian;
    return config;
}

Eigen::Matrix2d in_plane(const PlaneTensor& s) {
    return (Eigen::Matrix2d() << s.xx, s.xy, s.xy, s.yy).finished();
}

/// A square that is moved as told, at its reference temperature.
class Driven {
  public:
    explicit Driven(BodyConfig config)
        : config_(std::move(config)), domains_(make_domains(config_.mesh, config_.smoothing)),
          elasticity_(config_, domains_), temperature_(config_.mesh.node.size(), 300.0),
          force_(2 * temperature_.size()) {}

    /// Nodes at place(X); returns the nodal forces.
    template <class Place>
    const std::vector<double>& move(const Place& place) {
        const auto u =
            test::nodal_vector(config_.mesh, [&](const Point& p) -> Point { return place(p) - p; });
        elasticity_.forces(u, 1, temperature_, force_);
        return force_;
    }
    /// Largest component by which the stress of any domain differs from `expected`.
    double difference(const Eigen::Matrix2d& expected) const {
        double largest = 0;
        for (std::size_t k = 0; k < domains_.size(); ++k) {
            const auto s = in_plane(elasticity_.domain_stress(k, temperature_));
            largest = std::max(largest, (s - expected).cwiseAbs().maxCoeff());
        }
        return largest;
    }
    const BodyConfig& config() const { return config_; }

  private:
    BodyConfig config_;
    Domains domains_;
    Elasticity elasticity_;
    std::vector<double> temperature_, force_;
};

class Kinds : public testing::TestWithParam<Smoothing> {};

TEST_P(Kinds, LinearDisplacementGivesTheUniformStressOfTheLawAndNoInnerForce) {
    BodyConfig config = updated(test::distorted_square(6));
    config.smoothing = GetParam();
    Driven square(config);
    const Eigen::Matrix2d f = (Eigen::Matrix2d() << 1.2, 0.3, -0.1, 0.9).finished();
    const std::vector<double> force = square.move([&](const Point& p) -> Point { return f * p; });
    // dt L on the middle geometry is 2 (F - I) (F + I)^-1.
    const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d l = 2 * (f - unit) * (f + unit).inverse();
    const Eigen::Matrix2d d = 0.5 * (l + l.transpose());
    const Material& m = config.material;
    const Eigen::Matrix2d half =
        Eigen::Rotation2Dd(std::atan(0.25 * (l(1, 0) - l(0, 1)))).toRotationMatrix();
    const Eigen::Matrix2d stress = m.lambda() * d.trace() * unit + 2 * m.mu() * d;
    EXPECT_LT(square.difference(half * stress * half.transpose()), rounding);
    for (std::size_t i = 0; i < config.mesh.node.size(); ++i) {
        if (!test::on_unit_square(config.mesh.node[i])) {
            EXPECT_NEAR(force[2 * i], 0, rounding);
            EXPECT_NEAR(force[2 * i + 1], 0, rounding);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(SolidUpdated, Kinds, testing::Values(Smoothing::edge, Smoothing::element));

/// Stretched, then turned by 360 degrees: by `steps` exact rotations, or by steps along
/// v = Omega x r of the middle, which turn by 2 atan(Omega dt/2). Returns the end's error.
double error_after_a_turn(int steps, bool exact) {
    Driven square(updated(test::distorted_square(4)));
    const Eigen::Matrix2d stretch = (Eigen::Matrix2d() << 1.1, 0, 0, 1).finished();
    square.move([&](const Point& p) -> Point { return stretch * p; });
    const double dxx = 2 * 0.1 / 2.1;
    const Material& m = square.config().material;
    Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
    stress(0, 0) = (m.lambda() + 2 * m.mu()) * dxx;
    stress(1, 1) = m.lambda() * dxx;
    EXPECT_LT(square.difference(stress), rounding);
    const double step = 2 * std::numbers::pi / steps;
    const double angle = exact ? step : 2 * std::atan(step / 2);
    for (int i = 1; i <= steps; ++i) {
        const Eigen::Matrix2d r = Eigen::Rotation2Dd(i * angle).toRotationMatrix();
        square.move([&](const Point& p) -> Point { return r * stretch * p; });
    }
    return square.difference(stress) / stress(0, 0);
}

TEST(SolidUpdated, RigidRotationTurnsTheStressExactly) {
    EXPECT_LT(error_after_a_turn(100, true), 1e-11); // rounding of a hundred steps
    EXPECT_LT(error_after_a_turn(5, true), 1e-12);   // however large the steps
}

TEST(SolidUpdated, DrivenRotationEndsWithAnErrorOfSecondOrder) {
    // The angle falls short by (Omega dt)^3/12 a step: 2 pi (Omega dt)^2/12 in a turn.
    const double coarse = error_after_a_turn(100, false), fine = error_after_a_turn(1000, false);
    EXPECT_NEAR(coarse / fine, 100, 2);
    EXPECT_LT(coarse, 3e-3);
}

TEST(SolidUpdated, SimpleShearIsJaumannsOwnAnswer) {
    std::vector<double> error;
    for (const int steps : {200, 400, 800}) {
        Driven square(updated(test::distorted_square(3)));
        const double g = square.config().material.mu();
        double largest = 0;
        for (int i = 1; i <= steps; ++i) {
            const double gamma = 2 * std::numbers::pi * i / steps;
            square.move([&](const Point& p) -> Point { return {p.x() + gamma * p.y(), p.y()}; });
            Eigen::Matrix2d expected;
            expected << g * (1 - std::cos(gamma)), g * std::sin(gamma), g * std::sin(gamma),
                -g * (1 - std::cos(gamma));
            largest = std::max(largest, square.difference(expected) / g);
        }
        error.push_back(largest);
    }
    EXPECT_LT(error[2], 2e-5);
    EXPECT_NEAR(error[0] / error[1], 4, 0.1); // second order
    EXPECT_NEAR(error[1] / error[2], 4, 0.1);
}

TEST(SolidUpdated, AgreesWithTheTotalDescriptionWhereStrainsAreSmall) {
    // A strip swings freely after a push.
    std::vector<std::vector<double>> end;
    for (const Kinematics kinematics :
         {Kinematics::total_lagrangian, Kinematics::updated_lagrangian}) {
        BodyConfig config = updated(rectangle_mesh({0, 0}, 1, 0.25, 0.125));
        config.kinematics = kinematics;
        config.stiffness_damping = 0.05;
        config.boundary = {test::side(At::left, 1, 0.25)};
        config.boundary[0].fixed_x = config.boundary[0].fixed_y = true;
        Body body(config);
        const auto v = test::nodal_vector(
            config.mesh, [](const Point& p) { return Point(0, 1e-4 * p.x() * p.x()); });
        body.mechanics()->set_motion(std::vector<double>(v.size(), 0.0), v, body.temperature());
        body.advance(10);
        std::vector<double> displacement(body.mechanics()->displacement().begin(),
                                         body.mechanics()->displacement().end());
        end.push_back(displacement);
    }
    double size = 0, difference = 0;
    for (std::size_t c = 0; c < end[0].size(); ++c) {
        size = std::max(size, std::abs(end[0][c]));
        difference = std::max(difference, std::abs(end[0][c] - end[1][c]));
    }
    EXPECT_GT(size, 1e-6);
    EXPECT_LT(difference, 2e-3 * size); // strains of 1e-4 and their squares
}

TEST(SolidUpdated, RelaxationFindsTheEquilibriumOfNewtonsMethod) {
    BodyConfig config = updated(rectangle_mesh({0, 0}, 1, 0.25, 0.125));
    config.material.thermal_expansion = 0;
    config.boundary = {test::side(At::left, 1, 0.25), test::side(At::right, 1, 0.25)};
    config.boundary[0].fixed_x = config.boundary[0].fixed_y = true;
    config.boundary[1].traction = {0, 1e-5};
    Body relaxed(config);
    config.kinematics = Kinematics::total_lagrangian;
    Body solved(config);
    EXPECT_LE(relaxed.find_equilibrium(1e-6).residual, 1e-6);
    solved.find_equilibrium();
    const std::size_t tip = 2 * solved.nodes() - 1;
    const double deflection = solved.mechanics()->displacement()[tip];
    EXPECT_NEAR(relaxed.mechanics()->displacement()[tip], deflection, 1e-3 * deflection);
    // The reaction holds the load: traction times height.
    double up = 0, along = 0;
    const std::vector<double> reaction = solved.mechanics()->reaction();
    for (std::size_t c = 0; c < reaction.size(); ++c) {
        (c % 2 ? up : along) += reaction[c];
    }
    EXPECT_NEAR(up, -1e-5 * 0.25, 1e-13);
    EXPECT_NEAR(along, 0, 1e-13);
}

TEST(SolidUpdated, RelaxationDoesNotCycleAndLeavesTheClockAlone) {
    // A square on 8 x 8 cells; with steps of one length relaxation is caught in a cycle. The load
    // grows from a value at the start that the equilibrium belongs to.
    BodyConfig config = updated(rectangle_mesh({0, 0}, 1, 1, 1.0 / 8));
    config.boundary = {test::side(At::left), test::side(At::right)};
    config.boundary[0].fixed_x = config.boundary[0].fixed_y = true;
    config.boundary[1].traction.x = Field([](const Point&, double t) { return 0.01 * (1 + t); });
    Body body(config);
    const Equilibrium found = body.find_equilibrium(1e-8);
    EXPECT_LE(found.residual, 1e-8);
    EXPECT_LT(found.iterations, 20000);
    double pull = 0;
    const std::vector<double> reaction = body.mechanics()->reaction();
    for (std::size_t c = 0; c < reaction.size(); c += 2) {
        pull += reaction[c];
    }
    EXPECT_NEAR(pull, -0.01, 1e-8);
    body.step(1e-6); // the first one: half an edge of traction in the corner
    EXPECT_NEAR(body.mechanics()->load(2 * body.nodes() - 2), 0.01 / 16 * (1 + 1e-6), 1e-12);
    EXPECT_EQ(body.heat().account().thermoelastic == 0, false);
    EXPECT_LT(std::abs(body.heat().account().thermoelastic), 1e-9); // not that of the way there
}

TEST(SolidUpdated, ImplicitStepsAreRefused) {
    BodyConfig config = updated(test::distorted_square(3));
    config.stepping = Stepping::implicit_steps;
    EXPECT_THROW(Body{config}, std::invalid_argument);
}

} // namespace
} // namespace duet::solid
