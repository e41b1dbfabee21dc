// Budgets that must close to rounding, compartments, and states that must stay as they are.

#include "fluid_support.hpp"

#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

/// A warm cavity with a cold body in it, buoyant.
struct Stirred {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    std::vector<Chain> chains;
    InterfaceState state;

    Stirred() {
        config.walls = {{"left", {0, 0}, {0, 1}, 1.0, {}}};
        config.kinematic_viscosity = 0.71;
        config.thermal_expansion = 1;
        config.gravity = {0, -7.1e4};
        config.initial_temperature = 0.5;
        config.reference_temperature = 0.5;
        square_body({0.4, 0.4}, 0.2, 8, chains, state);
    }
};

TEST(FluidBudget, HeatHeldIsHeatPassed) {
    Stirred scene;
    Fluid fluid(scene.config, scene.chains, scene.state);
    double interface = 0, wall = 0;
    for (int window = 0; window < 20; ++window) {
        fluid.advance(1e-3, scene.state, scene.state);
        for (const double heat : fluid.passed().heat) {
            interface -= heat;
        }
        wall += fluid.walls()[0].heat_flow * 1e-3;
    }
    const Ledger l = fluid.ledger();
    EXPECT_GT(l.max_speed, 1) << "the flow must stir, or the shift's part is not tested";
    EXPECT_GT(l.closure_shift_abs, 0);
    EXPECT_GT(std::abs(l.heat_from_interface), 1e-3);
    EXPECT_GT(l.heat_from_walls, 1e-3);
    const double scale = std::abs(l.heat_from_interface) + l.heat_from_walls;
    EXPECT_NEAR(l.heat, l.heat_from_interface + l.heat_from_walls, 1e-12 * scale);
    EXPECT_NEAR(l.heat_from_interface, interface, 1e-14 * scale);
    EXPECT_NEAR(l.heat_from_walls, wall, 1e-14 * scale);
    EXPECT_EQ(l.particles_outside, 0u);
}

TEST(FluidBudget, ABodyIsPressedByTheFluidItDisplaces) {
    // One temperature above the reference: b = (0, 10) m/s2 everywhere, held by the pressure alone,
    // which presses a body of area A down with rho b A and has no moment about its centre.
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.thermal_expansion = 1;
    config.gravity = {0, -10};
    config.initial_temperature = 1;
    std::vector<Chain> chains;
    InterfaceState state;
    square_body({0.4, 0.3}, 0.2, 8, chains, state);
    std::fill(state.temperature.begin(), state.temperature.end(), 1.0);
    Fluid fluid(config, chains, state);
    const double window = 0.01;
    fluid.advance(window, state, state);
    Vec2 force;
    double moment = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        const Vec2 f = (1 / window) * fluid.passed().impulse[i];
        force += f;
        moment += cross(state.position[i] - Vec2{0.5, 0.4}, f);
    }
    const double expected = 10 * 0.04;
    EXPECT_NEAR(force.x, 0, 1e-9 * expected);
    EXPECT_NEAR(force.y, -expected, 1e-9 * expected); // a linear pressure is extrapolated exactly
    EXPECT_NEAR(moment, 0, 1e-9 * expected);
    // The upper side bears more than the lower one lifts, by the height times the gradient.
    EXPECT_NEAR(fluid.at({0.5, 0.7}).pressure - fluid.at({0.5, 0.2}).pressure, 5, 1e-6);
    const Ledger l = fluid.ledger();
    EXPECT_NEAR(l.impulse_from_interface.y, expected * window, 1e-9 * expected * window);
    EXPECT_EQ(l.work_from_interface, 0) << "a body at rest does no work";
}

TEST(FluidBudget, LoadsFallOnTheNodesOfTheirSegment) {
    // The pressure is linear in y, so the nodes of a vertical side bear it in equal steps.
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.thermal_expansion = 1;
    config.gravity = {0, -10};
    config.initial_temperature = 1;
    std::vector<Chain> chains;
    InterfaceState state;
    square_body({0.4, 0.4}, 0.2, 4, chains, state); // segments as long as a spacing
    std::fill(state.temperature.begin(), state.temperature.end(), 1.0);
    Fluid fluid(config, chains, state);
    const double window = 0.01;
    fluid.advance(window, state, state);
    // Nodes 1, 2, 3 lie within the bottom, 5, 6, 7 within the right side; p = 10 (y - yc), so the
    // right side's nodes are pushed left by 10 (y - yc) dx; neighbours differ by 10 dx^2.
    const auto push = [&](std::size_t node) { return -fluid.passed().impulse[node].x / window; };
    EXPECT_NEAR(push(6) - push(5), 10 * 0.05 * 0.05, 1e-9);
    EXPECT_NEAR(push(7) - push(6), 10 * 0.05 * 0.05, 1e-9);
    EXPECT_NEAR(push(2), 0, 1e-12);
}

TEST(FluidBudget, AnAdiabaticCavityKeepsItsHeat) {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.kinematic_viscosity = 0.71;
    config.thermal_expansion = 1;
    config.gravity = {0, -7.1e4};
    Fluid fluid(config);
    fluid.set_fields([](Vec2 x) {
        return Values{
            std::exp(-20 * ((x.x - 0.4) * (x.x - 0.4) + (x.y - 0.3) * (x.y - 0.3))), {}, 0};
    });
    fluid.advance(0.01);
    EXPECT_GT(fluid.ledger().max_speed, 1);
    const double held = fluid.ledger().mass * fluid.ledger().mean_temperature;
    EXPECT_NEAR(fluid.ledger().heat, 0, 1e-13 * held);
}

TEST(FluidBudget, RestStaysAtRestInAnyPolygon) {
    // One temperature, but not the reference: buoyancy must be held by the pressure alone, whether
    // its known part is kept apart (zero_mean) or all of it is carried (free).
    for (const PressureLevel level : {PressureLevel::zero_mean, PressureLevel::free}) {
        Config config =
            closed({{0, 0}, {1.1, 0.1}, {1.3, 0.7}, {0.6, 1.2}, {-0.1, 0.6}}, 0.1, false);
        config.thermal_expansion = 1;
        config.gravity = {0, -10};
        config.initial_temperature = 1;
        config.sound_speed = 30;
        config.pressure_level = level;
        Fluid fluid(config);
        fluid.advance(4); // sound crosses 100 times
        // The hydrostatic field is linear, for which every operator is exact; the sound of the
        // start dies out as exp(-nu k^2 t / 2), k = pi/1.2: by 1e-6 from sqrt(g H) = 3.5 m/s.
        EXPECT_LT(fluid.ledger().max_speed, 1e-4);
        const double slope = (fluid.at({0.5, 0.8}).pressure - fluid.at({0.5, 0.3}).pressure) / 0.5;
        EXPECT_NEAR(slope, 10, 1e-3);
        EXPECT_NEAR(fluid.particle_volume() * static_cast<double>(fluid.size()), 1.13, 1e-12);
    }
}

TEST(FluidBudget, FluxOfALinearTemperatureIsExact) {
    Config config = closed({{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}, 0.05, false);
    config.conductivity = 3;
    config.disorder = 0.1;
    config.walls = {{"cold", {0, 0}, {0, 0.5}, 0.0, {}}, {"hot", {1, 0}, {1, 0.5}, 2.0, {}}};
    Fluid fluid(config);
    fluid.set_fields([](Vec2 x) { return Values{2 * x.x, {}, 0}; });
    fluid.advance(0.02);
    const double exact = 1e-6; // the operators' single precision
    EXPECT_NEAR(fluid.walls()[0].heat_flow, -3 * 2 * 0.5, exact);
    EXPECT_NEAR(fluid.walls()[1].heat_flow, 3 * 2 * 0.5, exact);
    EXPECT_NEAR(fluid.at({0.23, 0.31}).temperature, 0.46, exact);
}

/// A lid on a cavity of some micrometres does what it does on one of a metre: nothing is compared
/// with a length of ours, and no sum of lengths with another to the last digit.
TEST(FluidBudget, UnitsDoNotShow) {
    const auto kinetic_energy = [](double side) {
        Config config = closed({{0, 0}, {side, 0}, {side, side}, {0, side}}, 0.05 * side, false);
        config.kinematic_viscosity = side / 20;
        config.disorder = 0.1;
        config.sound_speed = 15;
        config.walls = {{"lid", {0, side}, {side, side}, {}, {}}};
        config.walls[0].velocity.x = 1.0;
        Fluid fluid(config);
        fluid.advance(0.1 * side);
        return fluid.ledger().kinetic_energy / (side * side);
    };
    const double one = kinetic_energy(1);
    EXPECT_GT(one, 0.01);
    for (const double side : {2e-5, 3e-3, 7e4}) {
        EXPECT_NEAR(kinetic_energy(side), one, 1e-5 * one) << "a side of " << side << " m";
    }
}

/// A probe away from walls: a quadratic and its slope, to rounding.
TEST(FluidBudget, AProbeOfAQuadraticIsExact) {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.disorder = 0.15;
    Fluid fluid(config);
    const auto field = [](Vec2 p) {
        const double x = p.x, y = p.y;
        return Values{3 + 2 * x - y + 5 * x * x - 4 * x * y + 7 * y * y,
                      {1 - x * x + x * y, 2 + 3 * y * y - x},
                      0,
                      {2 + 10 * x - 4 * y, -1 - 4 * x + 14 * y}};
    };
    fluid.set_fields(field);
    for (const Vec2 place : {Vec2{0.5, 0.5}, Vec2{0.31, 0.67}, Vec2{0.72, 0.28}}) {
        const Values found = fluid.at(place), exact = field(place);
        EXPECT_NEAR(found.temperature, exact.temperature, 1e-12);
        EXPECT_NEAR(found.velocity.x, exact.velocity.x, 1e-12);
        EXPECT_NEAR(found.velocity.y, exact.velocity.y, 1e-12);
        EXPECT_NEAR(found.temperature_slope.x, exact.temperature_slope.x, 1e-10);
        EXPECT_NEAR(found.temperature_slope.y, exact.temperature_slope.y, 1e-10);
    }
}

TEST(FluidBudget, EachCompartmentHasItsOwnPressureAndHeat) {
    // A band from bottom to top warms the fluid on its left and cools the one on its right.
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.thermal_expansion = 1;
    config.gravity = {0, -10};
    const InterfaceState state{
        {{0.4, 1}, {0.4, 0}, {0.6, 0}, {0.6, 1}}, std::vector<Vec2>(4), {1, 1, 0, 0}};
    Fluid fluid(config, {{{0, 1}, false}, {{2, 3}, false}}, state);
    ASSERT_EQ(fluid.compartments(), 2u);
    ASSERT_EQ(fluid.size(), 320u);
    fluid.set_fields([](Vec2 x) { return Values{x.x < 0.5 ? 0 : 0.3 + x.y, {}, 0}; });
    struct Side {
        double pressure = 0, heat = 0;
    };
    const auto side = [&](bool on_left) {
        Side total;
        const Snapshot s = fluid.snapshot();
        for (std::size_t i = 0; i < fluid.size(); ++i) {
            if ((s.position[i].x < 0.5) == on_left) {
                total.pressure += s.pressure[i];
                total.heat += s.temperature[i] * fluid.particle_volume();
            }
        }
        return total;
    };
    const Side left = side(true), right = side(false);
    fluid.advance(0.05, state, state);
    EXPECT_NEAR(side(true).pressure, 0, 1e-9);
    EXPECT_NEAR(side(false).pressure, 0, 1e-9);
    EXPECT_LT(fluid.passed().heat[0], -0.01);
    EXPECT_GT(fluid.passed().heat[1], 0.01);
    EXPECT_NEAR(side(true).heat - left.heat, -fluid.passed().heat[0], 1e-13);
    EXPECT_NEAR(side(false).heat - right.heat, -fluid.passed().heat[1], 1e-13);
}

TEST(FluidBudget, NoHeatPassesAnInsulatedBody) {
    Stirred scene;
    scene.chains[0].insulated = true;
    std::fill(scene.state.temperature.begin(), scene.state.temperature.end(), 5.0);
    Fluid fluid(scene.config, scene.chains, scene.state);
    for (int window = 0; window < 5; ++window) {
        fluid.advance(1e-3, scene.state, scene.state);
        EXPECT_EQ(fluid.passed().heat, std::vector<double>(fluid.passed().heat.size()));
    }
    const Ledger l = fluid.ledger();
    EXPECT_GT(l.heat_from_walls, 1e-3);
    EXPECT_NEAR(l.heat, l.heat_from_walls, 1e-12 * l.heat_from_walls);
}

TEST(FluidBudget, ForcesAreMeansSinceTheLastMark) {
    Stirred scene;
    Fluid fluid(scene.config, scene.chains, scene.state);
    fluid.advance(1e-3, scene.state, scene.state);
    fluid.mark();
    Vec2 impulse;
    double heat = 0;
    for (const double window : {1e-3, 2e-3}) {
        fluid.advance(window, scene.state, scene.state);
        for (const Vec2 node : fluid.passed().impulse) {
            impulse += node;
        }
        for (const double segment : fluid.passed().heat) {
            heat += segment;
        }
    }
    ASSERT_GT(std::abs(impulse.y), 0);
    EXPECT_NEAR(
        fluid.ledger().force_on_solids.y, impulse.y / 3e-3, 1e-10 * std::abs(impulse.y / 3e-3));
    EXPECT_NEAR(fluid.ledger().heat_flow_to_solids, heat / 3e-3, 1e-10 * std::abs(heat / 3e-3));
}

TEST(FluidBudget, TheWorkOfAMovingBodyIsItsForceTimesItsWay) {
    // The velocities given at the ends are not the way over the window: within it the interface
    // moves so that its way is the integral of its velocity, and the books follow that.
    Stirred scene;
    const double window = 1e-4;
    InterfaceState end = scene.state;
    for (std::size_t i = 0; i < end.position.size(); ++i) {
        end.position[i] += Vec2{3e-5, -1e-5};
        scene.state.velocity[i] = {0.7, 0};
        end.velocity[i] = {0.1, -0.3};
    }
    Fluid fluid(scene.config, scene.chains, scene.state);
    ASSERT_EQ(fluid.advance(window, scene.state, end), 1);
    Vec2 impulse;
    for (const Vec2 node : fluid.passed().impulse) {
        impulse += node;
    }
    const double work = dot(impulse, Vec2{3e-5, -1e-5}) / window; // on the body
    ASSERT_GT(std::abs(work), 0);
    EXPECT_NEAR(fluid.ledger().work_from_interface, -work, 1e-9 * std::abs(work));
}

TEST(FluidBudget, AFluidThatTurnsWithABodyDoesNotDragIt) {
    // In a rigid turn there is no strain: du_t/dn and the turn of the wall itself cancel. One of
    // them alone would make the moment 2 mu Omega times the area, or minus that.
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.kinematic_viscosity = 1;
    std::vector<Chain> chains;
    InterfaceState start;
    square_body({0.4, 0.4}, 0.2, 8, chains, start);
    const double turn = 0.5, window = 1e-6;
    const auto velocity = [&](Vec2 x) { return turn * Vec2{0.5 - x.y, x.x - 0.5}; };
    InterfaceState end = start;
    for (std::size_t i = 0; i < start.position.size(); ++i) {
        start.velocity[i] = end.velocity[i] = velocity(start.position[i]);
        end.position[i] += window * start.velocity[i];
    }
    Fluid fluid(config, chains, start);
    fluid.set_fields([&](Vec2 x) { return Values{0, velocity(x), 0}; });
    fluid.advance(window, start, end);
    double moment = 0;
    for (std::size_t i = 0; i < start.position.size(); ++i) {
        moment += cross(start.position[i] - Vec2{0.5, 0.5}, fluid.passed().impulse[i]) / window;
    }
    EXPECT_NEAR(moment, 0, 1e-3 * 2 * turn * 0.04);
}

TEST(FluidBudget, WhatTheFlowLosesIsWhatViscosityTakes) {
    // A vortex runs down in a closed box. It starts to lose nu int |grad v|^2 = 2 pi^2 nu J/m and
    // second, and what neither the viscous term nor any work explains falls with the spacing.
    struct Share {
        double rate_error, unexplained, with_start;
    };
    const auto shares = [](double spacing, double sound_speed) {
        Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, spacing, false);
        config.kinematic_viscosity = 0.05;
        config.sound_speed = sound_speed;
        Fluid fluid(config);
        const double pi = std::acos(-1.0);
        fluid.set_fields([&](Vec2 x) {
            const double sx = std::sin(pi * x.x), sy = std::sin(pi * x.y);
            return Values{
                0, {sx * sx * std::sin(2 * pi * x.y), -sy * sy * std::sin(2 * pi * x.x)}, 0};
        });
        const double before = fluid.ledger().kinetic_energy, start = 1e-4;
        fluid.advance(start);
        const double rate = fluid.ledger().viscous_loss / start;
        fluid.advance(0.4); // it starts without its pressure: until the sound of that has died
        const Ledger settled = fluid.ledger();
        fluid.advance(0.1);
        const Ledger l = fluid.ledger();
        EXPECT_LT(l.kinetic_energy, 0.8 * before);
        EXPECT_NEAR(l.mechanical_residual, l.kinetic_energy - before + l.viscous_loss, 1e-12);
        return Share{std::abs(rate / (2 * pi * pi * config.kinematic_viscosity) - 1),
                     std::abs(l.mechanical_residual - settled.mechanical_residual)
                         / (l.viscous_loss - settled.viscous_loss),
                     std::abs(l.mechanical_residual) / l.viscous_loss};
    };
    // With c = 10 U, as by default, and the sound of the start: what the pressure holds counts too.
    EXPECT_LT(shares(0.05, 0).with_start, 0.015);
    EXPECT_LT(shares(0.025, 0).with_start, 0.0065);
    // With c = 20 U that is a quarter.
    const Share coarse = shares(0.05, 20), fine = shares(0.0125, 20);
    // The rate at second order, less what the first spacing is short of it.
    EXPECT_LT(coarse.rate_error, 0.02);
    EXPECT_LT(fine.rate_error, 0.1 * coarse.rate_error);
    EXPECT_LT(coarse.unexplained, 0.003); // measured 0.0027 and 0.00017
    EXPECT_LT(fine.unexplained, 0.0004);
    EXPECT_LT(fine.unexplained, 0.1 * coarse.unexplained);
}

TEST(FluidBudget, WhatALidPutsInIsWhatViscosityTakes) {
    const auto unexplained = [](double spacing, double sound_speed, double from) {
        Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, spacing, false);
        config.walls = {{"lid", {0, 1}, {1, 1}, {}, {1, 0}}};
        config.kinematic_viscosity = 0.1;
        config.sound_speed = sound_speed;
        Fluid fluid(config);
        fluid.advance(from);
        const Ledger settled = fluid.ledger();
        fluid.advance(1);
        const Ledger l = fluid.ledger();
        return std::abs(l.mechanical_residual - settled.mechanical_residual)
               / (l.work_from_walls - settled.work_from_walls);
    };
    // No order: the velocity jumps at the lid's ends, and so does what particles there make of it.
    EXPECT_LT(unexplained(0.05, 40, 0.5), 0.01); // the lid starts at once, which is loud
    EXPECT_LT(unexplained(0.025, 40, 0.5), 0.01);
    EXPECT_LT(unexplained(0.05, 0, 1e-9), 0.02); // with the start and c = 10 U
    EXPECT_LT(unexplained(0.025, 0, 1e-9), 0.015);
}

TEST(FluidBudget, ALatticeThatFitsIsKept) {
    Stirred scene;
    const Fluid fluid(scene.config, scene.chains, scene.state);
    EXPECT_EQ(fluid.size(), 384u); // (1 - 0.04) / 0.05^2
    EXPECT_NEAR(fluid.particle_volume(), 0.05 * 0.05, 1e-17);
}

TEST(FluidBudget, TheMovingWallOfACouetteFlow) {
    // A lid over a shallow cavity drags the fluid to the right above and it returns below.
    Config config = closed({{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0.1, false);
    config.walls = {{"lid", {0, 1}, {2, 1}, {}, {1, 0}}};
    config.kinematic_viscosity = 0.1;
    Fluid fluid(config);
    fluid.advance(5);
    EXPECT_GT(fluid.at({1, 0.95}).velocity.x, 0.3);
    EXPECT_LT(fluid.at({1, 0.4}).velocity.x, 0);
    EXPECT_LT(fluid.walls()[0].force.x, 0) << "the fluid holds the lid back";
}

TEST(FluidBudget, ALidSetsTheSpeedOfSoundBeforeTheFluidMoves) {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05, false);
    config.kinematic_viscosity = 1e-3;
    config.walls = {{"lid", {0, 1}, {1, 1}, {}, {1, 0}}};
    Fluid fluid(config);
    EXPECT_LE(fluid.stable_step(), 0.35 * config.spacing);
    fluid.advance(0.2);
    EXPECT_GE(fluid.ledger().sound_speed, 9);
    EXPECT_GT(fluid.ledger().max_speed, 0.1);
    EXPECT_LT(fluid.ledger().max_speed, 1.1);
}

TEST(FluidBudget, DivergenceIsReported) {
    Config config = closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.1, false);
    config.sound_speed = 1; // far too low for the flow
    Fluid fluid(config);
    fluid.set_fields([](Vec2 x) { return Values{0, {50 * std::sin(9 * x.y), 0}, 0}; });
    try {
        fluid.advance(1);
        FAIL() << "nothing was thrown";
    } catch (const Diverged& error) {
        EXPECT_NE(std::string(error.what()).find("sound speed"), std::string::npos);
    }
}

} // namespace
} // namespace duet::fluid::test
