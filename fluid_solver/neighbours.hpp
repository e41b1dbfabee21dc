// The neighbours of one particle, side by side in local arrays.

#pragma once

#include "fluid_solver/particles.hpp"
#include "fluid_solver/vector.hpp"

#include <array>
#include <bit>
#include <cstdint>
#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace duet::fluid {

constexpr int most_neighbours = 64;

/// x = x_a - x_b, r2 = |x|^2 > 0 and the index of each neighbour b, in the order of the cells.
struct Neighbours {
    int count = 0;
    alignas(32) std::array<double, most_neighbours> x, y, r2;
    std::array<std::uint32_t, most_neighbours> index;

    void drop(int k); ///< removes neighbour k, keeping the order of the others
};

namespace detail {

/// Appends the particles of [first, last) that lie within the support but not at (xa, ya) itself.
/// Each is written in any case and kept only if it counts: no branch to mispredict.
inline void append(const Particles& particles,
                   std::uint32_t first,
                   std::uint32_t last,
                   double xa,
                   double ya,
                   double support2,
                   Neighbours& found) {
    auto n = static_cast<std::size_t>(found.count);
    for (std::uint32_t b = first; b < last && n < most_neighbours; ++b) {
        const double x = xa - particles.x[b], y = ya - particles.y[b], r2 = x * x + y * y;
        found.x[n] = x;
        found.y[n] = y;
        found.r2[n] = r2;
        found.index[n] = b;
        n += (r2 < support2) & (r2 > 0);
    }
    found.count = static_cast<int>(n);
}

#ifdef __AVX2__
/// For each of the 16 patterns of kept lanes, the lanes in order, as pairs of 32-bit halves.
struct Packing {
    alignas(32) std::int32_t halves[16][8];
    alignas(16) std::int32_t words[16][4];
};
constexpr Packing packing = [] {
    Packing p{};
    for (int pattern = 0; pattern < 16; ++pattern) {
        int n = 0;
        for (int lane = 0; lane < 4; ++lane) {
            if (pattern >> lane & 1) {
                p.halves[pattern][2 * n] = 2 * lane;
                p.halves[pattern][2 * n + 1] = 2 * lane + 1;
                p.words[pattern][n++] = lane;
            }
        }
    }
    return p;
}();

/// The same, four at a time. Writes up to three entries beyond the last.
inline void append_packed(const Particles& particles,
                          std::uint32_t first,
                          std::uint32_t last,
                          double xa,
                          double ya,
                          double support2,
                          Neighbours& found) {
    auto n = static_cast<std::size_t>(found.count);
    const __m256d x4 = _mm256_set1_pd(xa), y4 = _mm256_set1_pd(ya);
    const __m256d least = _mm256_setzero_pd(), most = _mm256_set1_pd(support2);
    std::uint32_t b = first;
    for (; b + 4 <= last && n + 4 <= most_neighbours; b += 4) {
        const __m256d x = _mm256_sub_pd(x4, _mm256_loadu_pd(&particles.x[b]));
        const __m256d y = _mm256_sub_pd(y4, _mm256_loadu_pd(&particles.y[b]));
        const __m256d r2 = _mm256_add_pd(_mm256_mul_pd(x, x), _mm256_mul_pd(y, y));
        const auto pattern = static_cast<unsigned>(_mm256_movemask_pd(_mm256_and_pd(
            _mm256_cmp_pd(r2, most, _CMP_LT_OQ), _mm256_cmp_pd(r2, least, _CMP_GT_OQ))));
        const __m256i order =
            _mm256_load_si256(reinterpret_cast<const __m256i*>(packing.halves[pattern]));
        const auto pack = [&](double* to, __m256d values) {
            _mm256_storeu_pd(to,
                             _mm256_castsi256_pd(
                                 _mm256_permutevar8x32_epi32(_mm256_castpd_si256(values), order)));
        };
        pack(&found.x[n], x);
        pack(&found.y[n], y);
        pack(&found.r2[n], r2);
        const __m128i lanes =
            _mm_load_si128(reinterpret_cast<const __m128i*>(packing.words[pattern]));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(&found.index[n]),
                         _mm_add_epi32(_mm_set1_epi32(static_cast<int>(b)), lanes));
        n += static_cast<unsigned>(std::popcount(pattern));
    }
    found.count = static_cast<int>(n);
    append(particles, b, last, xa, ya, support2, found);
}
#endif

} // namespace detail

/// Finds all particles closer to `a` than `support`, at most the cell size of the grid that the
/// particles were sorted by; one at the very same place as `a` has no direction and is left out.
/// Returns false if there are `most_neighbours` or more.
inline bool find_neighbours(const Particles& particles,
                            const CellGrid& grid,
                            double support,
                            std::size_t a,
                            Neighbours& found) {
    const double xa = particles.x[a], ya = particles.y[a];
    const int column = grid.column(xa), row = grid.row(ya);
    const auto& start = particles.cell_start();
    found.count = 0;
    for (int r = row - 1; r <= row + 1; ++r) {
        const std::uint32_t first = start[grid.index(column - 1, r)];
        const std::uint32_t last = start[grid.index(column + 2, r)];
#ifdef __AVX2__
        detail::append_packed(particles, first, last, xa, ya, support * support, found);
#else
        detail::append(particles, first, last, xa, ya, support * support, found);
#endif
    }
    return found.count < most_neighbours;
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
