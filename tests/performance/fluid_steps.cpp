// A heated cavity of 40 x 40 particles over a few outer steps, for counting instructions. Prints
// the number of particle steps.

#include "fluid_solver/fluid.hpp"

#include <iostream>

int main() {
    using namespace duet::fluid;
    Config config; // lengths in L, time in L^2/alpha, Ra = 1e6
    config.spacing = 1.0 / 40;
    config.region = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    config.kinematic_viscosity = 0.71;
    config.conductivity = 1;
    config.thermal_expansion = 1;
    config.gravity = {0, -0.71e6};
    config.initial_temperature = config.reference_temperature = 0.5;
    config.disorder = 0.1;
    config.walls = {{"hot", {0, 0}, {0, 1}, 1.0, {}}, {"cold", {1, 0}, {1, 1}, 0.0, {}}};
    Fluid fluid(config);
    std::size_t steps = 0;
    while (steps < 20) {
        steps += static_cast<std::size_t>(fluid.advance(4 * fluid.stable_step()));
    }
    std::cout << steps * fluid.size() << '\n';
}
