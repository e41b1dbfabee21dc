// Whole outer steps of a buoyant cavity of n x n particles in a roll: cost of a particle step by
// phase, and memory for each particle at the peak.
//
//     build/release/bin/bench_fluid_steps 1000 100 1       (n, outer steps, threads)

#include "benchmarks/heated_cavity.hpp"
#include "fluid_solver/fluid.hpp"

#include <sys/resource.h>

#include <cstdlib>
#include <ctime>
#include <iostream>

int main(int argc, char** argv) {
    using namespace duet::fluid;
    if (argc != 4) {
        std::cerr << "usage: bench_fluid_steps PARTICLES_ALONG_A_SIDE OUTER_STEPS THREADS\n";
        return 1;
    }
    Config config = heated_cavity(1e6, 1.0 / std::atoi(argv[1]));
    config.disorder = 0.1;
    config.threads = std::atoi(argv[3]);
    Fluid fluid(config);
    fluid.set_fields(roll);
    const std::clock_t start = std::clock();
    int steps = 0;
    while (steps < std::atoi(argv[2])) {
        steps += fluid.advance(0.75 * fluid.stable_step()); // two inner steps in each
    }
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto count = static_cast<double>(fluid.size());
    std::cout << fluid.size() << " particles, " << steps
              << " outer steps: " << 1e9 * seconds / (steps * count) << " CPU ns a particle step, "
              << 1024.0 * static_cast<double>(usage.ru_maxrss) / count
              << " bytes a particle at the peak\n";
    for (const Phase& phase : fluid.phases()) {
        std::cout << "  " << phase.name << ": " << 1e9 * phase.seconds / (steps * count) << " ns\n";
    }
    return 0;
}
