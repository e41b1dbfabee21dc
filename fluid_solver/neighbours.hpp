// The neighbours of one particle, side by side in local arrays.

#pragma once

#include "fluid_solver/particles.hpp"
#include "fluid_solver/vector.hpp"

#include <array>
#include <cstdint>

namespace duet::fluid {

constexpr int most_neighbours = 64;

/// x = x_a - x_b, r2 = |x|^2 > 0 and the index of each neighbour b, in the order of the cells.
struct Neighbours {
    int count = 0;
    alignas(32) std::array<double, most_neighbours> x, y, r2;
    std::array<std::uint32_t, most_neighbours> index;

    void drop(int k); ///< removes neighbour k, keeping the order of the others
};

/// Finds all particles but `a` itself closer than `support`, at most the cell size of the grid that
/// the particles were sorted by. Returns false if there are more than `most_neighbours`.
inline bool find_neighbours(const Particles& particles,
                            const CellGrid& grid,
                            double support,
                            std::size_t a,
                            Neighbours& found) {
    const double xa = particles.x[a], ya = particles.y[a], support2 = support * support;
    const int column = grid.column(xa), row = grid.row(ya);
    const auto& start = particles.cell_start();
    int n = 0;
    for (int r = row - 1; r <= row + 1; ++r) {
        const std::uint32_t end = start[grid.index(column + 2, r)];
        for (std::uint32_t b = start[grid.index(column - 1, r)]; b < end; ++b) {
            const double x = xa - particles.x[b], y = ya - particles.y[b];
            const double r2 = x * x + y * y;
            // Written in any case, kept only if within the support: no branch to mispredict.
            const auto k = static_cast<std::size_t>(n);
            found.x[k] = x;
            found.y[k] = y;
            found.r2[k] = r2;
            found.index[k] = b;
            n += (r2 < support2) & (b != a);
            if (n == most_neighbours) {
                return false;
            }
        }
    }
    found.count = n;
    return true;
}

inline void Neighbours::drop(int k) {
    --count;
    for (auto i = static_cast<std::size_t>(k); i < static_cast<std::size_t>(count); ++i) {
        x[i] = x[i + 1];
        y[i] = y[i + 1];
        r2[i] = r2[i + 1];
        index[i] = index[i + 1];
    }
}

} // namespace duet::fluid
