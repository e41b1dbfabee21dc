// Plane strain and plane stress, and mass-proportional damping.

#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

namespace duet::solid {
namespace {

using test::At;

/// A square on rollers at its left and bottom, pulled along x on its right.
BodyConfig pulled(Plane plane, double traction) {
    BodyConfig config = test::steel_like(test::distorted_square(4));
    config.plane = plane;
    config.boundary = {test::side(At::left), test::side(At::bottom), test::side(At::right)};
    config.boundary[0].fixed_x = config.boundary[1].fixed_y = true;
    config.boundary[2].traction = {traction, 0};
    return config;
}

class BothKinematics : public testing::TestWithParam<Kinematics> {};

TEST_P(BothKinematics, UniaxialStressStretchesByYoungsModulusOfThePlane) {
    for (const Plane plane : {Plane::strain, Plane::stress}) {
        constexpr double traction = 1e-6;
        BodyConfig config = pulled(plane, traction);
        config.kinematics = GetParam();
        Body body(config);
        body.find_equilibrium(1e-9);
        const double nu = config.material.poissons_ratio, e = config.material.youngs_modulus;
        const bool stress = plane == Plane::stress;
        const double along = stress ? traction / e : traction * (1 - nu * nu) / e;
        const double across = stress ? -nu * traction / e : -nu * (1 + nu) * traction / e;
        for (std::size_t i = 0; i < body.nodes(); ++i) {
            const Point& p = config.mesh.node[i];
            const double ux = body.mechanics()->displacement()[2 * i];
            const double uy = body.mechanics()->displacement()[2 * i + 1];
            EXPECT_NEAR(ux, along * p.x(), 2e-6 * along); // the strain's square, and the residual
            EXPECT_NEAR(uy, across * p.y(), 2e-6 * along);
        }
        const PlaneTensor s = body.mechanics()->domain_stress(0, body.temperature());
        EXPECT_NEAR(s.xx, traction, 2e-6 * traction);
        EXPECT_NEAR(s.zz, stress ? 0 : nu * traction, 2e-6 * traction);
    }
}

TEST_P(BothKinematics, WarmPlateExpandsFreelyInPlaneStress) {
    constexpr double warming = 1e-3; // a strain of 2e-5
    BodyConfig config = pulled(Plane::stress, 0);
    config.kinematics = GetParam();
    config.initial_temperature = config.reference_temperature + warming;
    Body body(config);
    body.find_equilibrium(1e-9);
    const double strain = config.material.thermal_expansion * warming;
    for (std::size_t c = 0; c < 2 * body.nodes(); ++c) {
        const double place = config.mesh.node[c / 2][static_cast<Eigen::Index>(c % 2)];
        EXPECT_NEAR(body.mechanics()->displacement()[c], strain * place, 4 * strain * strain);
    }
}

INSTANTIATE_TEST_SUITE_P(SolidPlane,
                         BothKinematics,
                         testing::Values(Kinematics::total_lagrangian,
                                         Kinematics::updated_lagrangian));

TEST(SolidPlane, PulledPlateCoolsByKelvinsFormula) {
    // Uniaxial stress without conduction cools by alpha T0 sigma/(rho c_sigma), rho c_sigma =
    // rho c + 3 alpha beta T0 the capacity at constant stress: tells the capacity of the plane and
    // its beta apart. In plane strain the side is held too, sigma_zz = nu sigma - E alpha dT.
    constexpr double traction = 1e-5;
    for (const Plane plane : {Plane::strain, Plane::stress}) {
        BodyConfig config = pulled(plane, traction);
        config.material.conductivity = 0;
        config.stiffness_damping = 0.3;
        Body body(config);
        body.advance(60); // damped to rest: exp(-20) of the slowest mode
        const Material& m = config.material;
        const double t0 = config.reference_temperature, a = m.thermal_expansion;
        const double capacity = m.density * m.heat_capacity + 3 * a * m.beta() * t0;
        double cooling = a * t0 * traction / capacity;
        if (plane == Plane::strain) {
            // dT = -(alpha T0/(rho c_sigma)) (sigma + nu sigma - E alpha dT)
            const double share = a * t0 / capacity;
            cooling =
                share * (1 + m.poissons_ratio) * traction / (1 - share * m.youngs_modulus * a);
        }
        for (const double t : body.temperature()) {
            EXPECT_NEAR(t0 - t, cooling, 1e-5 * cooling);
        }
    }
}

TEST(SolidMassDamping, FreeBodySlowsDownExponentially) {
    // M dv/dt = -a M v; centred, so that the rate is off by (a dt)^2/12, dt = 0.13 s here.
    for (const Stepping stepping : {Stepping::explicit_steps, Stepping::implicit_steps}) {
        BodyConfig config = test::steel_like(test::distorted_square(3));
        config.mass_damping = 0.7;
        config.initial_velocity = Point(0.3, -0.2);
        config.stepping = stepping;
        config.implicit_step = 0.05;
        Body body(config);
        body.advance(2);
        for (std::size_t i = 0; i < body.nodes(); ++i) {
            EXPECT_NEAR(body.velocity()[2 * i], 0.3 * std::exp(-1.4), 5e-4 * 0.3);
            EXPECT_NEAR(body.velocity()[2 * i + 1], -0.2 * std::exp(-1.4), 5e-4 * 0.3);
        }
    }
}

} // namespace
} // namespace duet::solid
