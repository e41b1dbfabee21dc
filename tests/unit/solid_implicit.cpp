// Implicit steps: exact accounts, agreement with explicit ones, no limit of the step.

#include "tests/unit/solid_support.hpp"

#include "solid_solver/state.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace duet::solid {
namespace {

using test::At;

BodyConfig heated_square() {
    BodyConfig config = test::steel_like(test::distorted_square(8));
    config.stepping = Stepping::implicit_steps;
    config.initial_temperature = 400;
    config.heat_source = 3;
    config.boundary = {test::side(At::left), test::side(At::right), test::side(At::top)};
    config.boundary[0].heat_flux = 11;
    config.boundary[1].convection = Convection{2, 290};
    config.boundary[2].temperature = 350;
    return config;
}

/// Body coupled strongly with its heat: C = beta^2 T0/(rho c (lambda + 2 mu)) = 1.86.
BodyConfig coupled_square() {
    BodyConfig config = test::steel_like(test::distorted_square(6));
    config.stepping = Stepping::implicit_steps;
    config.material.thermal_expansion = 0.04;
    config.boundary = {test::side(At::left)};
    config.boundary[0].fixed_x = config.boundary[0].fixed_y = true;
    return config;
}

std::vector<double> pull(const Body& body, double force) {
    std::vector<double> nodal(2 * body.nodes(), 0.0);
    nodal[2 * body.nodes() - 2] = force;
    nodal[2 * body.nodes() - 1] = -0.5 * force;
    return nodal;
}

TEST(SolidImplicit, StoredHeatIsAllThatCameIn) {
    for (const Motion motion : {Motion::fixed, Motion::deformable}) {
        BodyConfig config = heated_square();
        config.motion = motion;
        Body body(config);
        std::vector<double> heat(body.nodes(), 0.0);
        heat[4] = -7; // a node of the bottom side
        body.set_interface_load(heat, std::vector<double>(2 * body.nodes(), 0.0));
        for (int i = 0; i < 5; ++i) {
            body.advance(1); // 500 times the explicit limit of the conduction
        }
        const HeatAccount& account = body.heat().account();
        EXPECT_NEAR(account.interface, -7 * 5, 1e-12);
        EXPECT_NEAR(account.sources, 3 * 5, 1e-12);
        const double in =
            account.interface + account.sources + account.walls + account.thermoelastic;
        EXPECT_NEAR(body.heat().stored(), in, 1e-12 * 2400); // of what is held
        EXPECT_EQ(account.thermoelastic == 0, motion == Motion::fixed);
    }
}

TEST(SolidImplicit, LongHeatStepsGoToTheSteadyState) {
    // q in on the left, h (T - Tinf) out on the right: T = Tinf + q/h + q (1 - x)/k, without
    // overshoot lasting: steps of a hundred thousand times the explicit limit.
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 0.2, 0.1));
    config.motion = Motion::fixed;
    config.stepping = Stepping::implicit_steps;
    config.boundary = {test::side(At::left, 1, 0.2), test::side(At::right, 1, 0.2)};
    config.boundary[0].heat_flux = 14;
    config.boundary[1].convection = Convection{7, 280};
    Body body(config);
    for (int i = 0; i < 4; ++i) {
        body.advance(1e4);
    }
    for (std::size_t i = 0; i < body.nodes(); ++i) {
        const double x = config.mesh.node[i].x();
        EXPECT_NEAR(body.temperature()[i], 282 + 20 * (1 - x), 1e-6);
    }
}

TEST(SolidImplicit, MomentumIsTheImpulseOfTheLoads) {
    BodyConfig config = coupled_square();
    config.boundary.clear();
    Body body(config);
    double impulse = 0;
    for (int i = 1; i <= 10; ++i) { // another load in every window
        const double force = 0.02 * std::cos(i);
        body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body, force));
        body.advance(0.3);
        impulse += 0.3 * force;
        double x = 0, y = 0;
        for (std::size_t n = 0; n < body.nodes(); ++n) {
            x += body.mechanics()->mass()[n] * body.velocity()[2 * n];
            y += body.mechanics()->mass()[n] * body.velocity()[2 * n + 1];
        }
        EXPECT_NEAR(x, impulse, 1e-14); // what Newton's method leaves is less than 1e-10 of it
        EXPECT_NEAR(y, -0.5 * impulse, 1e-14);
    }
}

TEST(SolidImplicit, AgreesWithSmallExplicitSteps) {
    // With both dampings, strong coupling and conduction; the error of an implicit step of a
    // fortieth of the slowest period falls with its square.
    BodyConfig config = coupled_square();
    config.stiffness_damping = 0.02;
    config.mass_damping = 0.3;
    std::vector<double> error;
    Body fine(config);
    config.stepping = Stepping::explicit_steps;
    Body reference(config);
    const auto start = [&](Body& body) {
        body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body, 0.02));
    };
    start(reference);
    const double step = 0.02 * reference.stable_step();
    const int steps = static_cast<int>(std::ceil(2 / step));
    for (int i = 0; i < steps; ++i) {
        reference.step(2.0 / steps);
    }
    config.stepping = Stepping::implicit_steps;
    double size = 0;
    for (const double dt : {0.2, 0.1, 0.05}) {
        config.implicit_step = dt;
        Body body(config);
        start(body);
        body.advance(2);
        double squares = 0;
        size = 0;
        for (std::size_t c = 0; c < 2 * body.nodes(); ++c) {
            const double place = config.mesh.node[c / 2][static_cast<Eigen::Index>(c % 2)];
            squares += std::pow(body.position()[c] - reference.position()[c], 2);
            size += std::pow(reference.position()[c] - place, 2);
        }
        error.push_back(std::sqrt(squares / size));
    }
    EXPECT_LT(error[2], 3e-3) << error[0] << ' ' << error[1] << ' ' << error[2];
    EXPECT_GT(error[0] / error[2], 9); // between order 1.6 and 2: the load is sudden
}

TEST(SolidImplicit, PrescribedTemperatureThatSwingsIsFollowedInSecondOrder) {
    // A slab between a wall that swings and an insulated one, against explicit steps of 1e-4 s.
    BodyConfig config = test::steel_like(rectangle_mesh({0, 0}, 1, 0.1, 0.1));
    config.motion = Motion::fixed;
    config.boundary = {test::side(At::left, 1, 0.1)};
    config.boundary[0].temperature =
        Field([](const Point&, double t) { return 300 + 10 * std::sin(3 * t); });
    Body reference(config);
    for (int i = 0; i < 20000; ++i) {
        reference.step(1e-4);
    }
    config.stepping = Stepping::implicit_steps;
    std::vector<double> error;
    for (const double dt : {0.2, 0.1, 0.05}) {
        config.implicit_step = dt;
        Body body(config);
        body.advance(2);
        double largest = 0;
        for (std::size_t i = 0; i < body.nodes(); ++i) {
            largest =
                std::max(largest, std::abs(body.temperature()[i] - reference.temperature()[i]));
        }
        error.push_back(largest);
    }
    EXPECT_LT(error[2], 0.05) << error[0] << ' ' << error[1] << ' ' << error[2];
    EXPECT_GT(error[0] / error[1], 3.3); // order 2; 2 where stages see the value of the step's end
    EXPECT_GT(error[1] / error[2], 3.3);
}

TEST(SolidImplicit, ABodyFarFromTheOriginIsSolvedAsWell) {
    // What a position can hold goes by the body's size, not by where it is. Places of a power of
    // two: the gradients have the same bits.
    std::vector<double> tip;
    for (const double y : {0.0, 1048576.0}) {
        BodyConfig config = coupled_square();
        config.mesh = rectangle_mesh({0, y}, 1, 1, 0.25);
        config.boundary[0].from.y() += y;
        config.boundary[0].to.y() += y;
        Body body(config);
        body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body, 1e-8));
        body.advance(0.5);
        tip.push_back(body.mechanics()->displacement()[2 * body.nodes() - 2]);
    }
    EXPECT_GT(tip[0], 1e-10);
    EXPECT_NEAR(tip[1], tip[0], 1e-8 * tip[0]); // 1e-10 of the forces is left
}

TEST(SolidImplicit, AConstantDisplacementDoesNotForbidImplicitSteps) {
    // Stretched by a hundredth and let go: with the heat conducted away it rests in the linear
    // answer of a bar between rollers.
    BodyConfig config = coupled_square();
    config.thermoelastic_heating = false;
    config.stiffness_damping = 1;
    config.boundary = {test::side(At::left), test::side(At::right), test::side(At::bottom)};
    config.boundary[0].displacement_x = 0.0;
    config.boundary[1].displacement_x = 0.01;
    config.boundary[2].fixed_y = true;
    Body body(config);
    for (int i = 0; i < 40; ++i) {
        body.advance(5);
    }
    // Plane strain, free at the top: E_yy = -nu/(1 - nu) E_xx with E = g + g^2/2.
    const double exx = 0.01 + 0.5e-4, eyy = -0.3 / 0.7 * exx;
    const double lift = std::sqrt(1 + 2 * eyy) - 1;
    EXPECT_NEAR(body.mechanics()->displacement()[2 * body.nodes() - 1], lift, 1e-9);
}

TEST(SolidImplicit, LongStepsOfAStronglyCoupledBodyAreStable) {
    // Steps of hundreds of times the explicit limit, from a rough start.
    Body body(coupled_square());
    test::Noise noise;
    std::vector<double> u(2 * body.nodes(), 0.0), v(2 * body.nodes());
    std::generate(v.begin(), v.end(), [&] { return 0.01 * noise(); });
    body.mechanics()->set_motion(u, v, body.temperature());
    const double before = body.mechanics()->kinetic_energy();
    const double step = 200 * body.stable_step();
    for (int i = 0; i < 100; ++i) {
        body.advance(step);
        EXPECT_LT(body.mechanics()->kinetic_energy() + body.mechanics()->strain_energy(), before);
    }
    EXPECT_LT(body.mechanics()->kinetic_energy(), 1e-6 * before); // L-stable: it comes to rest
}

TEST(SolidImplicit, FactorIsReusedWhileItConverges) {
    Body body(coupled_square());
    body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body, 1e-4));
    for (int i = 0; i < 50; ++i) {
        body.advance(0.1);
    }
    EXPECT_EQ(body.implicit()->factorisations(), 1u);
    EXPECT_LT(body.implicit()->iterations(), 50 * 2 * 12u);
}

TEST(SolidImplicit, RestoredStateGoesOnInTheSameBits) {
    // Large rotations renew the factor now and then; the restored body must have the same one.
    BodyConfig config = coupled_square();
    std::vector<BodyConfig> bodies{config};
    Solid whole(bodies, {}), resumed(bodies, {});
    std::string state;
    for (int i = 0; i < 12; ++i) {
        Body& body = whole.bodies()[0];
        body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body, 0.3));
        body.advance(0.5);
        if (i == 5) {
            state = save_state(whole);
        }
    }
    restore_state(resumed, state);
    for (int i = 6; i < 12; ++i) {
        Body& body = resumed.bodies()[0];
        body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body, 0.3));
        body.advance(0.5);
    }
    EXPECT_GT(whole.bodies()[0].implicit()->factorisations(), 2u);
    EXPECT_EQ(save_state(whole), save_state(resumed));
}

TEST(SolidImplicit, AutomaticStepsGoByTheCost) {
    BodyConfig config = coupled_square();
    config.stepping = Stepping::automatic;
    for (const bool longer : {false, true}) {
        Body body(config);
        const double window = (longer ? 1000 : 10) * body.stable_step();
        const Body::Plan plan = body.plan(window);
        EXPECT_EQ(plan.implicit, longer) << plan.reason;
        EXPECT_NEAR(plan.explicit_steps, (longer ? 1000 : 10) / 0.9, 1);
        EXPECT_EQ(body.advance(window), longer ? 1u : static_cast<unsigned>(plan.explicit_steps));
        EXPECT_EQ(body.implicit()->factorisations(), longer ? 1u : 0u);
        body.advance(0.001 * window); // once chosen it stays so: the scheme does not change midway
        EXPECT_EQ(body.implicit()->factorisations() > 0, longer);
    }
}

TEST(SolidImplicit, OneAndTwoThreadsGiveTheSameBits) {
    std::vector<std::string> states;
    for (const int threads : {1, 2}) {
        BodyConfig config = coupled_square();
        config.mesh = rectangle_mesh({0, 0}, 1, 1, 1.0 / 60); // 10 920 domains: two pieces
        config.threads = threads;
        Solid solid({config}, {});
        Body& body = solid.bodies()[0];
        body.set_interface_load(std::vector<double>(body.nodes(), 0.0), pull(body, 0.01));
        body.advance(0.1);
        states.push_back(save_state(solid));
    }
    EXPECT_EQ(states[0], states[1]);
}

} // namespace
} // namespace duet::solid
