// The mechanical energy of a body: what it holds is what came in.

#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

namespace duet::solid {
namespace {

using test::At;

/// A warm square that is pulled, shaken at its left side and pressed on at its right one.
BodyConfig shaken() {
    BodyConfig config = test::steel_like(test::distorted_square(6));
    config.initial_temperature =
        Field([](const Point& p, double) { return 300 + 5 * p.x() * p.y(); }, false);
    config.body_force = {0, -0.1};
    config.boundary = {test::side(At::left), test::side(At::right)};
    config.boundary[0].fixed_x = true;
    config.boundary[0].displacement_y =
        Field([](const Point&, double t) { return 0.01 * std::sin(3 * t); });
    config.boundary[1].pressure = Field([](const Point&, double t) { return 0.02 * t; });
    return config;
}

std::vector<double> pull(const Body& body) {
    std::vector<double> nodal(2 * body.nodes(), 0.0);
    nodal[2 * 24] = 0.05; // a node inside
    nodal[2 * 24 + 1] = -0.02;
    return nodal;
}

/// What the kinetic energy has beyond the work of all forces, and the sum of what passed.
std::pair<double, double> kinetic_balance(const Body& body, double start) {
    const Work& work = body.mechanics()->work();
    const double supports = body.mechanics()->support_work();
    const double in = work.interface + work.loads + supports + work.stress - work.mass_damping;
    return {body.kinetic_energy() - start - in - work.steps,
            std::abs(work.interface) + std::abs(work.loads) + std::abs(supports)
                + std::abs(work.stress) + work.mass_damping};
}

TEST(SolidEnergy, KineticEnergyIsTheWorkOfAllForcesToRounding) {
    for (const Kinematics kinematics :
         {Kinematics::total_lagrangian, Kinematics::updated_lagrangian}) {
        BodyConfig config = shaken();
        config.kinematics = kinematics;
        config.mass_damping = 0.3;
        config.stiffness_damping = 0.01;
        Body body(config);
        const double start = body.kinetic_energy();
        EXPECT_GT(start, 0);                         // the shaken side
        for (int window = 0; window < 5; ++window) { // steps of different lengths
            body.set_interface_load(std::vector<double>(body.nodes(), 0.0),
                                    window % 2 ? std::vector<double>(2 * body.nodes(), 0.0)
                                               : pull(body));
            body.advance(0.3 + 0.1 * window);
        }
        const auto [rest, passed] = kinetic_balance(body, start);
        EXPECT_GT(passed, 1e-3);
        EXPECT_NEAR(rest, 0, 1e-13 * passed) << passed;
        EXPECT_GT(body.energy().dissipated, body.mechanics()->work().mass_damping);
    }
}

/// Of the shaken body after two seconds, by steps of a `share` of the stable one.
EnergyAccount shaken_energy(double share, bool heated, Kinematics kinematics, double damping) {
    BodyConfig config = shaken();
    config.kinematics = kinematics;
    config.stiffness_damping = damping;
    config.thermoelastic_heating = heated;
    Body body(config);
    body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body));
    const double steps = std::ceil(2 / (share * body.stable_step()));
    for (double i = 0; i < steps; ++i) {
        body.step(2 / steps);
    }
    const EnergyAccount energy = body.energy();
    EXPECT_GT(energy.interface, 1e-4);
    EXPECT_GT(energy.loads, 1e-4);
    EXPECT_GT(std::abs(energy.supports), 1e-4);
    EXPECT_GT(energy.expansion, 5e-3); // it is warm and free to expand
    return energy;
}

TEST(SolidEnergy, StoredEnergyIsWhatCameInButForTheSquareOfTheStep) {
    // The strain energy is a polynomial of the fourth degree in the motion: a step's mean force
    // does its work but for the cube of the step's way.
    for (const bool heated : {false, true}) {
        for (const double damping : {0.0, 0.02}) {
            const auto residual = [&](double share) {
                const EnergyAccount energy =
                    shaken_energy(share, heated, Kinematics::total_lagrangian, damping);
                if (damping == 0) {
                    EXPECT_EQ(energy.dissipated, 0);
                } else { // a part that the residual would show
                    EXPECT_GT(energy.dissipated, 0.5 * energy.expansion);
                }
                return std::abs(energy.residual()) / energy.expansion;
            };
            const double coarse = residual(0.4), fine = residual(0.1);
            EXPECT_LT(coarse, 0.01); // 1.5 % at 0.8 of the stable step: all modes swing
            EXPECT_GT(coarse / fine, 8) << coarse << ' ' << fine; // 16 for order 2
        }
    }
}

TEST(SolidEnergy, StiffnessDampingTakesTheSameInBothDescriptions) {
    // The laws differ by the strains, some per cent.
    const auto lost = [](Kinematics kinematics) {
        return shaken_energy(0.1, false, kinematics, 0.02).dissipated;
    };
    const double total = lost(Kinematics::total_lagrangian);
    EXPECT_NEAR(lost(Kinematics::updated_lagrangian), total, 0.05 * total);
}

TEST(SolidEnergy, ImplicitStepsLoseLittleOfWhatTheyResolve) {
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 0.25, 0.125));
    config.stepping = Stepping::implicit_steps;
    config.thermoelastic_heating = false;
    config.boundary = {test::side(At::left, 1, 0.25)};
    config.boundary[0].fixed_x = config.boundary[0].fixed_y = true;
    config.body_force = {0, -0.005};
    std::vector<double> lost;
    for (const double step : {0.4, 0.2}) {
        config.implicit_step = step;
        Body body(config);
        body.advance(8);
        const EnergyAccount energy = body.energy();
        EXPECT_GT(energy.loads, 0);
        EXPECT_NEAR(energy.stored, energy.loads - energy.dissipated, 1e-15);
        lost.push_back(energy.dissipated / energy.loads);
    }
    EXPECT_GT(lost[1], 0);
    EXPECT_LT(lost[1], 0.02) << lost[0] << ' ' << lost[1];
    EXPECT_GT(lost[0] / lost[1], 3); // of the third order a step's length, of sudden loads less
}

} // namespace
} // namespace duet::solid
