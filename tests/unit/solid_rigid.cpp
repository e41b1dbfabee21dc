// Rigid bodies that move by the forces on them, against closed forms.

#include "solid_solver/solid.hpp"
#include "solid_solver/state.hpp"
#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace duet::solid {
namespace {

using test::At;

/// The unit square of density 2: M = 2, I = 2/6.
BodyConfig block() {
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 1, 0.25));
    config.motion = Motion::rigid;
    return config;
}

TEST(SolidRigid, MassAndInertiaAreThoseOfTheShape) {
    BodyConfig config = block();
    config.mesh = rectangle_mesh({3, 1}, 2, 0.5, 0.25);
    EXPECT_NEAR(Rigid(config).mass(), 2, 1e-14);
    EXPECT_NEAR(Rigid(config).inertia(), 2 * (4 + 0.25) / 12, 1e-13);
    EXPECT_NEAR((Rigid(config).centre() - Point(4, 1.25)).norm(), 0, 1e-14);
    config.support.pivot = Point(3, 1); // Steiner
    EXPECT_NEAR(Rigid(config).inertia(), 2 * ((4 + 0.25) / 12 + 1 + 0.0625), 1e-13);
    config = block();
    config.mesh.part.assign(config.mesh.triangle.size(), 0);
    for (std::size_t t = 0; t < config.mesh.part.size(); ++t) { // the right half is heavier
        config.mesh.part[t] = config.mesh.node[config.mesh.triangle[t][1]].x() > 0.6;
    }
    config.part_material = {config.material, config.material};
    config.part_material[1].density = 6;
    EXPECT_NEAR(Rigid(config).mass(), 1 + 3, 1e-14);
    EXPECT_NEAR(Rigid(config).centre().x(), (0.25 + 3 * 0.75) / 4, 1e-14);
}

TEST(SolidRigid, FallsFreely) {
    BodyConfig config = block();
    config.body_force = {0, -9.81};
    config.initial_velocity = Point(2, 0);
    Body body(config);
    for (int i = 0; i < 10; ++i) {
        body.advance(0.1); // a constant force: exact, however long the step
    }
    EXPECT_NEAR(body.rigid()->centre().x(), 2.5, 1e-13);
    EXPECT_NEAR(body.rigid()->centre().y(), 0.5 - 0.5 * 9.81, 1e-13);
    EXPECT_NEAR(body.rigid()->momentum().y(), -2 * 9.81, 1e-13);
    EXPECT_NEAR(body.rigid()->angle(), 0, 1e-13);
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        EXPECT_NEAR(body.position()[2 * i], config.mesh.node[i].x() + 2, 1e-13);
        EXPECT_NEAR(body.velocity()[2 * i + 1], -9.81, 1e-13);
    }
    EXPECT_NEAR(body.kinetic_energy(), 0.5 * 2 * (4 + 9.81 * 9.81), 1e-11);
}

TEST(SolidRigid, SpinsUpUnderAConstantTorque) {
    // A pressure on half a side turns with the body: torque p/8 about its held centre.
    BodyConfig config = block();
    config.support.fixed_x = config.support.fixed_y = true;
    config.mesh = rectangle_mesh({0, 0}, 1, 1, 0.25);
    config.boundary = {test::side(At::right)};
    config.boundary[0].from = {1, 0.5};
    config.boundary[0].pressure = 4;
    Body body(config);
    body.advance(3);
    const double rate = (4.0 / 8) / (2.0 / 6);
    const double turns = 0.5 * rate * 9;
    EXPECT_GT(turns, 6); // more than a turn
    EXPECT_NEAR(body.rigid()->angle(), turns, 1e-11);
    EXPECT_NEAR(body.rigid()->spin(), 3 * rate, 1e-12);
    EXPECT_NEAR((body.rigid()->centre() - Point(0.5, 0.5)).norm(), 0, 1e-15);
    const Point arm(0.5 * (std::cos(turns) - std::sin(turns)),
                    0.5 * (std::sin(turns) + std::cos(turns)));
    const std::size_t corner = body.nodes() - 1;
    EXPECT_NEAR(body.position()[2 * corner], 0.5 + arm.x(), 1e-11);
    EXPECT_NEAR(body.velocity()[2 * corner], -3 * rate * arm.y(), 1e-10);
}

TEST(SolidRigid, SwingsOnItsSprings) {
    BodyConfig config = block();
    config.support.spring_angle = 3;
    config.support.spring_y = 8;
    config.support.fixed_x = true;
    config.initial_velocity = VectorField(Field([](const Point& p, double) { return 0.5 - p.y(); }),
                                          Field([](const Point& p, double) { return p.x(); }));
    Body body(config);                    // spin 1, and 0.5 upwards
    const double turning = 3, rising = 2; // sqrt(3/I), sqrt(8/M)
    EXPECT_NEAR(body.rigid()->spin(), 1, 1e-13);
    const double before = body.kinetic_energy();
    for (int i = 1; i <= 200; ++i) {
        body.advance(0.1);
        const double t = 0.1 * i;
        // The frequency is off by 1e-4 at most: 60 rad until the end.
        EXPECT_NEAR(body.rigid()->angle(), std::sin(turning * t) / turning, 6e-3 / turning);
        EXPECT_NEAR(
            body.rigid()->centre().y() - 0.5, 0.5 * std::sin(rising * t) / rising, 2e-3 / rising);
        EXPECT_NEAR(body.kinetic_energy() + body.strain_energy(), before, 1e-3 * before);
    }
    EXPECT_NEAR(body.rigid()->centre().x(), 0.5, 1e-15);
}

TEST(SolidRigid, HangsFromItsPivotAsAPendulum) {
    // Let go at 60 degrees: the period of the elliptic integral K(sin 30 deg) = 1.6857503548.
    BodyConfig config = block();
    config.support.pivot = Point(0.5, 1);
    const double tilt = std::numbers::pi / 3, gravity = 5;
    config.body_force = gravity * Point(std::sin(tilt), -std::cos(tilt));
    Body body(config);
    const double frequency = std::sqrt(2 * gravity * 0.5 / body.rigid()->inertia());
    const double period = 4 * 1.6857503548 / frequency;
    body.advance(0.5 * period);
    EXPECT_NEAR(body.rigid()->angle(), 2 * tilt, 1e-3);
    EXPECT_NEAR(body.rigid()->spin(), 0, 5e-3);
    body.advance(0.5 * period);
    EXPECT_NEAR(body.rigid()->angle(), 0, 1e-3);
    EXPECT_EQ(body.rigid()->momentum(), Point(0, 0));
}

const std::vector<Point> cavity{{-2, -2}, {3, -2}, {3, 3}, {-2, 3}};

TEST(SolidRigid, MomentumIsTheImpulseOfTheInterface) {
    BodyConfig config = block();
    Solid solid({config}, cavity);
    test::Noise noise;
    std::vector<double> force(2 * solid.interface().node.size());
    const std::vector<double> heat(solid.interface().segment.size(), 0.0);
    const Rigid& rigid = *solid.bodies()[0].rigid();
    double spun = 0; // angular impulse about the origin, by the nodes' middle places in a window
    std::vector<double> before, after, velocity, temperature;
    for (int window = 0; window < 50; ++window) {
        std::generate(force.begin(), force.end(), [&] { return noise(); });
        solid.interface_state(before, velocity, temperature);
        solid.advance(0.01, force, heat);
        solid.interface_state(after, velocity, temperature);
        for (std::size_t c = 0; c < force.size(); c += 2) {
            spun += 0.01 * 0.5 * (before[c] + after[c]) * force[c + 1];
            spun -= 0.01 * 0.5 * (before[c + 1] + after[c + 1]) * force[c];
        }
        EXPECT_NEAR(rigid.momentum().x(), solid.account().impulse_x, 1e-15);
        EXPECT_NEAR(rigid.momentum().y(), solid.account().impulse_y, 1e-15);
        // The mean arm stands for the way within a window: second order.
        const Point c = rigid.centre(), p = rigid.momentum();
        const double spin = rigid.inertia() * rigid.spin() + c.x() * p.y() - c.y() * p.x();
        EXPECT_NEAR(spin, spun, 1e-5);
    }
    EXPECT_GT(std::abs(rigid.angle()), 1e-3);
    const double energy = solid.bodies()[0].kinetic_energy();
    EXPECT_NEAR(solid.account().work, energy, 1e-4 * energy); // of translation exact
}

TEST(SolidRigid, RestoredStateGoesOnInTheSameBits) {
    BodyConfig config = block();
    config.support.spring_angle = 3;
    config.boundary = {test::side(At::right)};
    config.boundary[0].pressure = Field([](const Point& p, double t) { return p.y() * t; });
    Solid whole({config}, cavity), resumed({config}, cavity);
    const std::vector<double> force(2 * whole.interface().node.size(), 0.1), heat(16, 1.0);
    whole.advance(0.3, force, heat);
    resumed.advance(0.7, force, heat);
    restore_state(resumed, save_state(whole));
    whole.advance(0.3, force, heat);
    resumed.advance(0.3, force, heat);
    EXPECT_TRUE(save_state(whole) == save_state(resumed));
}

TEST(SolidRigid, AnswersTheFluidAsAWhole) {
    // A disc: the normal's square integrates to half the perimeter, and pressure does not turn it.
    BodyConfig config = block();
    config.mesh = disc_mesh({0, 0}, 1, 0.1);
    config.support.pivot = Point(0, 0);
    EXPECT_GT(Solid({config}, cavity).added_mass_limit(1.5, 20), 1e20); // none but for rounding
    config.support.pivot.reset();
    const double half = 30 * 2 * std::sin(std::numbers::pi / 60);
    const double mass = 2 * mesh_area(config.mesh);
    EXPECT_NEAR(Solid({config}, cavity).added_mass_limit(1.5, 20), mass / (1.5 * 20 * half), 1e-12);
    // The shear along its rim turns it: D r^2 on 2 pi r, r the chords' distance from the centre.
    const double drag = 2 * 0.7 / (0.2 / 2), perimeter = 2 * half;
    const double apothem = std::cos(std::numbers::pi / 60);
    const double spin = drag * perimeter * apothem * apothem / Rigid(config).inertia();
    EXPECT_GT(spin, drag * half / mass); // more than what slows it down
    EXPECT_NEAR(Solid({config}, cavity).drag_limit(0.7, 0.2), 1 / spin, 1e-12);
    config.support.fixed_angle = true;
    EXPECT_NEAR(Solid({config}, cavity).drag_limit(0.7, 0.2), mass / (drag * half), 1e-12);
    // A square about its corner: sum of the arms' squares 2/3.
    config = block();
    config.support.pivot = Point(0, 0);
    config.mesh = rectangle_mesh({0, 0}, 1, 1, 1.0 / 64);
    const double inertia = 2 * (1.0 / 6 + 0.5);
    EXPECT_NEAR(Solid({config}, cavity).added_mass_limit(1.5, 20),
                inertia / (1.5 * 20 * 4.0 / 3),
                1e-3 * inertia / 40);
}

TEST(SolidRigid, BoundariesThatHoldNodesAreRefused) {
    BodyConfig config = block();
    config.boundary = {test::side(At::left)};
    config.boundary[0].fixed_x = true;
    EXPECT_THROW(Body{config}, std::invalid_argument);
}

} // namespace
} // namespace duet::solid
