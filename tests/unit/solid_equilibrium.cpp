// Static equilibrium by Newton's method.

#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

namespace duet::solid {
namespace {

using test::At;

/// A strip 1 x 0.25 clamped on its left side, with a dead shear traction on its right side.
BodyConfig cantilever(double traction) {
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 0.25, 0.125 / 2));
    config.boundary = {test::side(At::left, 1, 0.25), test::side(At::right, 1, 0.25)};
    config.boundary[0].fixed_x = config.boundary[0].fixed_y = true;
    config.boundary[1].traction = {0, traction};
    return config;
}

TEST(SolidEquilibrium, IsWhereADampedBodyComesToRest) {
    // Bent by some twentieth of its length, where a linear answer is off by 1e-3.
    BodyConfig config = cantilever(0.005);
    config.mesh = rectangle_mesh({0, 0}, 1, 0.25, 0.125);
    config.material.thermal_expansion = 0; // the moving one would warm and cool
    config.stiffness_damping = 1;
    Body resting(config), moving(config);
    EXPECT_LE(resting.find_equilibrium(1e-10).residual, 1e-10);
    moving.advance(200); // the first mode is damped by exp(-b w^2/2 t), some exp(-18)
    const std::size_t tip = resting.nodes() - 1;
    const double deflection = resting.position()[2 * tip + 1] - config.mesh.node[tip].y();
    EXPECT_GT(deflection, 0.03);
    for (std::size_t c = 0; c < 2 * resting.nodes(); ++c) {
        EXPECT_NEAR(resting.position()[c], moving.position()[c], 1e-6 * deflection);
        EXPECT_EQ(resting.velocity()[c], 0);
    }
}

TEST(SolidEquilibrium, ConvergesQuadratically) {
    // With an inexact tangent the last iterations would gain a factor each, and their number grow
    // with the digits asked for.
    Body coarse(cantilever(0.005)), fine(cantilever(0.005));
    const int few = coarse.find_equilibrium(1e-5).iterations;
    EXPECT_LE(fine.find_equilibrium(1e-10).iterations, few + 2);
}

TEST(SolidEquilibrium, LargeLoadsAreTakenInSteps) {
    Body body(cantilever(0.2)); // bends it by more than half its length
    EXPECT_LE(body.find_equilibrium().residual, 1e-9);
    const std::size_t tip = body.nodes() - 1;
    EXPECT_GT(body.position()[2 * tip + 1], 0.75);
    EXPECT_LT(body.position()[2 * tip], 0.9);
}

TEST(SolidEquilibrium, WarmBodyOnRollersExpandsFreely) {
    BodyConfig config = test::steel_like(test::distorted_square(4));
    config.initial_temperature = config.reference_temperature + 1;
    config.boundary = {test::side(At::left), test::side(At::bottom)};
    config.boundary[0].fixed_x = config.boundary[1].fixed_y = true;
    Body body(config);
    body.find_equilibrium();
    // Free of stress in the plane: E = alpha (1 + nu) dT in both directions, (F^2 - 1)/2.
    const double stretch =
        std::sqrt(1 + 2 * config.material.thermal_expansion * (1 + config.material.poissons_ratio));
    for (std::size_t c = 0; c < 2 * body.nodes(); ++c) {
        EXPECT_NEAR(body.position()[c],
                    stretch * config.mesh.node[c / 2][static_cast<Eigen::Index>(c % 2)],
                    1e-9);
    }
}

TEST(SolidEquilibrium, BodyThatNothingHoldsIsRefused) {
    BodyConfig config = cantilever(0.005);
    config.boundary.erase(config.boundary.begin());
    Body body(config);
    try {
        body.find_equilibrium();
        FAIL() << "found";
    } catch (const std::runtime_error& fault) {
        EXPECT_NE(std::string(fault.what()).find("no static equilibrium"), std::string::npos);
    }
}

} // namespace
} // namespace duet::solid
