// Threads, save and restore: the same bits.

#include "solid_solver/state.hpp"
#include "tests/unit/solid_support.hpp"

#include <gtest/gtest.h>

namespace duet::solid {
namespace {

BodyConfig wide(int threads) {
    // 8385 nodes: enough for all loops to be cut in two.
    BodyConfig config = test::steel_like(rectangle_mesh({1, 1}, 2, 1, 1.0 / 64));
    config.stiffness_damping = 1e-4;
    config.threads = threads;
    return config;
}

/// Loads on the interface that have no symmetry.
struct Loads {
    std::vector<double> force, heat;
    explicit Loads(const Solid& solid) {
        test::Noise noise;
        force.resize(2 * solid.interface().node.size());
        heat.resize(solid.interface().segment.size());
        std::generate(force.begin(), force.end(), [&] { return 1e-3 * noise(); });
        std::generate(heat.begin(), heat.end(), [&] { return noise(); });
    }
};

const std::vector<Point> cavity{{0, 0}, {4, 0}, {4, 3}, {0, 3}};

TEST(SolidState, OneAndTwoThreadsGiveTheSameBits) {
    std::string states[2];
    for (int threads = 1; threads <= 2; ++threads) {
        Solid solid({wide(threads)}, cavity);
        const Loads loads(solid);
        const double window = 10 * solid.bodies()[0].stable_step();
        solid.advance(window, loads.force, loads.heat);
        states[threads - 1] = save_state(solid);
    }
    EXPECT_TRUE(states[0] == states[1]);
}

TEST(SolidState, RestoringGivesTheBitsOfNeverHavingStopped) {
    std::vector<BodyConfig> bodies{test::steel_like(rectangle_mesh({0.5, 0.5}, 1, 1, 0.1)),
                                   test::steel_like(rectangle_mesh({2, 0.5}, 1, 1, 0.1))};
    bodies[1].motion = Motion::fixed;
    bodies[1].name = "heater";
    bodies[0].stiffness_damping = 1e-3;
    Solid one(bodies, cavity), other(bodies, cavity);
    const Loads loads(one);
    const std::vector<double> none(loads.heat.size(), 0.0);
    one.advance(0.3, loads.force, loads.heat);
    const std::string middle = save_state(one);
    const auto finish = [&](Solid& solid) {
        for (int window = 0; window < 40; ++window) { // past the next estimate of the frequency
            solid.advance(0.3, loads.force, window % 2 ? none : loads.heat);
        }
        return save_state(solid);
    };
    const std::string end = finish(one);
    other.advance(1.1, loads.force, none); // elsewhere before
    restore_state(other, middle);
    EXPECT_TRUE(save_state(other) == middle);
    EXPECT_TRUE(finish(other) == end);
    EXPECT_FALSE(middle == end);
}

TEST(SolidState, AStateOfAnotherSceneIsRefused) {
    Solid solid({test::steel_like(test::distorted_square(4))}, {});
    Solid larger({test::steel_like(test::distorted_square(5))}, {});
    EXPECT_THROW(restore_state(solid, save_state(larger)), std::invalid_argument);
    std::string state = save_state(solid);
    EXPECT_THROW(restore_state(solid, state + "x"), std::invalid_argument);
    state.resize(state.size() - 1);
    EXPECT_THROW(restore_state(solid, state), std::invalid_argument);
}

TEST(SolidExchange, HeatInIsHeatStoredToRounding) {
    std::vector<BodyConfig> bodies{test::steel_like(rectangle_mesh({0.5, 0.5}, 1, 1, 0.05))};
    bodies[0].motion = Motion::fixed;
    Solid solid(bodies, cavity);
    const Loads loads(solid);
    double booked = 0, absolute = 0;
    for (const double flow : loads.heat) {
        booked += 50 * 0.1 * flow;
        absolute += 50 * 0.1 * std::abs(flow);
    }
    for (int window = 0; window < 50; ++window) {
        solid.advance(0.1, loads.force, loads.heat);
    }
    EXPECT_NEAR(solid.account().heat, booked, 1e-12 * absolute);
    EXPECT_NEAR(solid.account().exchanged_heat, absolute, 1e-12 * absolute);
    // Each of the 441 nodes rounds its 300 K in every step: 1e-13 J a node, of either sign.
    EXPECT_NEAR(solid.bodies()[0].heat().stored(), booked, 1e-10);
}

TEST(SolidExchange, ASegmentHeatsItsTwoNodesAlike) {
    std::vector<BodyConfig> bodies{test::steel_like(rectangle_mesh({0.5, 0.5}, 1, 1, 0.25))};
    bodies[0].motion = Motion::fixed;
    bodies[0].material.conductivity = 0;
    Solid solid(bodies, cavity);
    std::vector<double> force(2 * solid.interface().node.size(), 0.0);
    std::vector<double> heat(solid.interface().segment.size(), 0.0);
    heat[2] = 8;
    solid.advance(0.5, force, heat);
    std::vector<double> position, velocity, temperature;
    solid.interface_state(position, velocity, temperature);
    for (std::size_t i = 0; i < temperature.size(); ++i) {
        const Interface::Node& node = solid.interface().node[i];
        const double capacity = solid.bodies()[0].heat().capacity()[node.node];
        const bool heated = i == 2 || i == 3;
        EXPECT_NEAR(capacity * (temperature[i] - 300), heated ? 0.5 * 8 * 0.5 : 0, 1e-11);
    }
}

// Free vibrations of a bar under no load: what the exchange asks for takes b w^2 of their energy.
TEST(SolidExchange, VibrationsFasterThanAWindowAreDampedByTheImpedance) {
    const double pi = 3.141592653589793, impedance = 0.002, window = 1;
    BodyConfig config = test::steel_like(rectangle_mesh({1, 1}, 2, 0.5, 0.125));
    config.material.thermal_expansion = 0;
    config.material.poissons_ratio = 0;
    config.initial_velocity = {
        Field([=](const Point& p, double) { return 1e-4 * std::cos(pi * (p.x() - 1) / 2); }), 0.0};
    Solid solid({config}, cavity);
    const std::vector<double> force(2 * solid.interface().node.size(), 0.0);
    const std::vector<double> heat(solid.interface().segment.size(), 0.0);
    const Mechanics& mechanics = *solid.bodies()[0].mechanics();
    const auto energy = [&] { return mechanics.kinetic_energy() + mechanics.strain_energy(); };
    const double start = energy(), time = 60 * window;
    for (int k = 0; k < 60; ++k) {
        solid.advance(window, force, heat);
    }
    const double undamped = energy();
    EXPECT_NEAR(undamped, start, 5e-3 * start); // explicit steps: to (w dt)^2/4
    for (int k = 0; k < 60; ++k) {
        solid.advance(window, force, heat, impedance);
    }
    const double frequency = pi / 2 * std::sqrt(5.0 / 2), damping = 5 * impedance * 5 / 2;
    EXPECT_DOUBLE_EQ(mechanics.stiffness_damping(), damping);
    const double rate = damping * frequency * frequency;
    EXPECT_NEAR(std::log(undamped / energy()) / time, rate, 0.03 * rate);
    // Never more than twice the critical damping of the fastest vibration.
    const double step = solid.bodies()[0].stable_step();
    solid.advance(window, force, heat, 1e6);
    EXPECT_GT(solid.bodies()[0].stable_step(), 0.23 * step);
}

TEST(SolidExchange, LimitsOfTheWindow) {
    std::vector<BodyConfig> bodies{test::steel_like(rectangle_mesh({0.5, 0.5}, 1, 1, 0.1))};
    Solid solid(bodies, cavity);
    // rho c dx_s/2 (dx/2) / (2 k_f) and rho_s dx_s / (rho_f c)
    EXPECT_NEAR(solid.exchange_limit(0.6, 0.2), 2 * 3 * 0.05 * 0.1 / 0.6 / 2, 1e-15);
    EXPECT_NEAR(solid.added_mass_limit(1.5, 20), 2 * 0.1 / (1.5 * 20), 1e-15);
    EXPECT_NEAR(solid.drag_limit(0.6, 0.2), 2 * 0.05 * 0.1 / 0.6 / 2, 1e-15);
    EXPECT_EQ(solid.exchange_limit(0, 0.2), 0);
    bodies[0].insulated = true;
    EXPECT_EQ(Solid(bodies, cavity).exchange_limit(0.6, 0.2), 0);
    EXPECT_GT(Solid(bodies, cavity).added_mass_limit(1.5, 20), 0);
    EXPECT_EQ(Solid(bodies, {}).exchange_limit(0.6, 0.2), 0);
}

} // namespace
} // namespace duet::solid
