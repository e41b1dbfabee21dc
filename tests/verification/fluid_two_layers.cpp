// A fluid layer at T = 1 beside a solid layer at T = 0, no gravity, insulated all round: the
// interface temperature just after contact follows from the effusivities, and what comes later from
// the Laplace-transformed solution.

#include "fluid_conductor.hpp"
#include "fluid_solver/fluid.hpp"

#include <gtest/gtest.h>

namespace duet::fluid::test {
namespace {

struct TwoLayers {
    TwoLayers(double conductivity, double capacity)
        : solid({1, 0}, 80, 8, 0.0125, capacity, conductivity, 0) {
        config.spacing = 0.025;
        config.region = {{0, 0}, {1, 0}, {1, 0.1}, {0, 0.1}};
        config.conductivity = 1;
        config.initial_temperature = 1;
        for (std::size_t j = 9; j-- > 0;) {
            wet.push_back(solid.node(0, j)); // downwards: the fluid lies to the right
        }
    }

    void run(double end) {
        const InterfaceState start = solid.state(wet);
        Fluid fluid(config, {chain_of(wet.size(), false)}, start);
        InterfaceState state = start;
        const double window = 0.15 * config.spacing * config.spacing / 1;
        const double before = solid.heat();
        for (double time = 0; time < end - 1e-12; time += window) {
            fluid.advance(window, state, state);
            solid.advance(window, wet, false, fluid.passed().heat);
            state = solid.state(wet);
        }
        received = (solid.heat() - before) / 0.1;
        interface = state.temperature[4];
        fluid_lost = -fluid.ledger().heat / 0.1;
    }

    Config config;
    Conductor solid;
    std::vector<std::size_t> wet;
    double interface = 0, received = 0, fluid_lost = 0;
};

TEST(FluidTwoLayers, EqualLayersMeetHalfWay) {
    TwoLayers layers(1, 1);
    layers.run(0.1);
    EXPECT_NEAR(layers.interface, 0.5, 0.005);
    EXPECT_NEAR(layers.fluid_lost, layers.received, 1e-12);
}

TEST(FluidTwoLayers, TenfoldConductivity) {
    TwoLayers layers(10, 1);
    layers.run(
        0.01); // the solid is warmed through at 0.1: its front arrives at x = 2 at about 0.02
    EXPECT_NEAR(layers.interface, 0.240253, 0.01 * 0.240253);
    EXPECT_NEAR(layers.fluid_lost, layers.received, 1e-12);
}

TEST(FluidTwoLayers, TenfoldCapacity) {
    TwoLayers layers(1, 10);
    layers.run(0.1);
    EXPECT_NEAR(layers.interface, 0.240253, 0.01 * 0.240253);
    EXPECT_NEAR(layers.received, 0.271096, 0.01 * 0.271096);
    EXPECT_NEAR(layers.fluid_lost, layers.received, 1e-12);
}

TEST(FluidTwoLayers, TenfoldCapacityUntilTheFluidCools) {
    TwoLayers layers(1, 10);
    layers.run(0.5);
    EXPECT_NEAR(layers.interface, 0.223655, 0.01 * 0.223655);
    EXPECT_NEAR(layers.received, 0.586595, 0.01 * 0.586595);
}

} // namespace
} // namespace duet::fluid::test
