// A heated cavity of 40 x 40 particles over a few outer steps, for counting instructions. Prints
// the number of particle steps.

#include "benchmarks/heated_cavity.hpp"
#include "fluid_solver/fluid.hpp"

#include <iostream>

int main() {
    using namespace duet::fluid;
    Config config = heated_cavity(1e6, 1.0 / 40);
    config.disorder = 0.1;
    Fluid fluid(config);
    std::size_t steps = 0;
    while (steps < 20) {
        // two inner steps in each
        steps += static_cast<std::size_t>(fluid.advance(0.75 * fluid.stable_step()));
    }
    std::cout << steps * fluid.size() << '\n';
}
