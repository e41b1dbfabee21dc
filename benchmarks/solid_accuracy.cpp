// Error against CPU time of edge domains (ES-FEM) and of plain T3, on the same meshes and through
// the same code: Cook's membrane, statically. Prints a table as in docs/verification.md.

#include "tests/verification/solid_statics.hpp"

#include <cstdio>
#include <ctime>

namespace {

using namespace duet::solid;

struct Answer {
    double deflection; ///< m, at (48, 52)
    double seconds;    ///< CPU, of mesh, domains and Newton's method
};

Answer solve(std::uint32_t n, Smoothing smoothing, double young, double poisson, double force) {
    const std::clock_t start = std::clock();
    Body body(test::cook(n, smoothing, young, poisson, force));
    body.find_equilibrium(1e-8);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    return {test::displacement_at(body, {48, 52}).y(), seconds};
}

} // namespace

int main() {
    // Small loads, so that the linear answers hold; the incompressible one is for a force of 100.
    constexpr double small = 1e-4;
    std::printf(
        "| cells | T3: error | CPU s | edge domains: error | CPU s | nu = 0.4999, T3 | edge "
        "domains |\n|---|---|---|---|---|---|---|\n");
    for (const std::uint32_t n : {8u, 16u, 32u, 64u, 128u}) {
        const auto error = [](double value, double exact) { return 100 * (value / exact - 1); };
        const Answer t3 = solve(n, Smoothing::element, 1, 1.0 / 3, small);
        const Answer edge = solve(n, Smoothing::edge, 1, 1.0 / 3, small);
        const Answer t3_stiff = solve(n, Smoothing::element, 240.565, 0.4999, 100 * small);
        const Answer edge_stiff = solve(n, Smoothing::edge, 240.565, 0.4999, 100 * small);
        std::printf("| %u x %u | %.2f %% | %.3f | %.2f %% | %.3f | %.1f %% | %.1f %% |\n",
                    n,
                    n,
                    error(t3.deflection / small, 21.52),
                    t3.seconds,
                    error(edge.deflection / small, 21.52),
                    edge.seconds,
                    error(t3_stiff.deflection / small, 7.69),
                    error(edge_stiff.deflection / small, 7.69));
    }
}
