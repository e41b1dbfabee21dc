// The neighbours of one particle, side by side in local arrays.

#pragma once

#include "fluid_solver/lanes.hpp"
#include "fluid_solver/particles.hpp"
#include "fluid_solver/vector.hpp"

#include <array>
#include <bit>
#include <cstdint>
#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace duet::fluid {

constexpr std::size_t most_neighbours = 64;

/// x = x_a - x_b and the index of each neighbour b, in the order of the cells. The arrays are
/// filled up to whole eights with entries at (pad, 0) and the index of the particle itself, which
/// count for nothing if pad lies beyond the support.
struct Neighbours {
    std::size_t count = 0;
    alignas(32) std::array<float, most_neighbours + eight> x, y;
    alignas(32) std::array<std::uint32_t, most_neighbours + eight> index;

    /// Number of eights that hold the neighbours.
    std::size_t eights() const { return (count + eight - 1) / eight; }
    void pad(float place, std::uint32_t self) {
        for (std::size_t k = count; k < count + eight; ++k) {
            x[k] = place;
            y[k] = 0;
            index[k] = self;
        }
    }
    /// Keeps the neighbours for which keep(k) holds, in their order.
    template <class Keep>
    void filter(const Keep& keep) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count; ++k) {
            x[kept] = x[k];
            y[kept] = y[k];
            index[kept] = index[k];
            kept += keep(k) ? 1 : 0;
        }
        count = kept;
    }
};

/// The particles of one cell and the eight about it, over periodic sides too: what any particle of
/// that cell may have as neighbours. Places are relative to the middle of the cell, so that single
/// precision holds their differences to 2e-7 of the support.
class Surroundings {
  public:
    /// Returns false if there are more than any sane cloud has.
    bool collect(const Particles& particles, const CellGrid& grid, int column, int row) {
        centre_ = grid.centre(column, row);
        count_ = 0;
        const auto& start = particles.cell_start();
        const bool seam = grid.at_seam(column, row);
        for (int r = row - 1; r <= row + 1; ++r) {
            if (!seam) {
                const std::size_t first = start[grid.index(column - 1, r)];
                const std::size_t last = start[grid.index(column + 2, r)];
                if (!add(particles, first, last, centre_)) {
                    return false;
                }
                continue;
            }
            for (int c = column - 1; c <= column + 1; ++c) {
                const CellGrid::Image image = grid.image(c, r);
                if (!add(particles,
                         start[image.cell],
                         start[image.cell + 1],
                         centre_ - image.shift)) {
                    return false;
                }
            }
        }
        // Whole eights are searched: what fills them up lies out of reach.
        for (std::size_t k = count_; k < count_ + eight; ++k) {
            x_[k] = y_[k] = std::numeric_limits<float>::max();
            index_[k] = 0;
        }
        return true;
    }

    /// Finds all particles closer to `place` than `support`, at most the cell size; one at the very
    /// same place has no direction and is left out. Returns false if there are more than there is
    /// room for.
    bool find(Vec2 place, float support, Neighbours& found) const {
#ifdef __AVX2__
        return find_packed(place, support, found);
#else
        return find_plainly(place, support, found);
#endif
    }

    /// Each candidate is written in any case and kept only if it counts: no branch to mispredict.
    bool find_plainly(Vec2 place, float support, Neighbours& found) const {
        const auto xa = static_cast<float>(place.x - centre_.x);
        const auto ya = static_cast<float>(place.y - centre_.y);
        const float support2 = support * support;
        std::size_t n = 0;
        for (std::size_t k = 0; k < count_ && n < most_neighbours; ++k) {
            const float x = xa - x_[k], y = ya - y_[k], r2 = x * x + y * y;
            found.x[n] = x;
            found.y[n] = y;
            found.index[n] = index_[k];
            n += (r2 < support2) & (r2 > 0) ? 1 : 0;
        }
        found.count = n;
        return n < most_neighbours;
    }

#ifdef __AVX2__
    /// The same, eight at a time.
    bool find_packed(Vec2 place, float support, Neighbours& found) const {
        const __m256 xa = _mm256_set1_ps(static_cast<float>(place.x - centre_.x));
        const __m256 ya = _mm256_set1_ps(static_cast<float>(place.y - centre_.y));
        const __m256 least = _mm256_setzero_ps(), support2 = _mm256_set1_ps(support * support);
        std::size_t n = 0;
        for (std::size_t k = 0; k < count_ && n < most_neighbours; k += eight) {
            const __m256 x = _mm256_sub_ps(xa, _mm256_load_ps(&x_[k]));
            const __m256 y = _mm256_sub_ps(ya, _mm256_load_ps(&y_[k]));
            const __m256 r2 = _mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y));
            const auto pattern = static_cast<unsigned>(_mm256_movemask_ps(_mm256_and_ps(
                _mm256_cmp_ps(r2, support2, _CMP_LT_OQ), _mm256_cmp_ps(r2, least, _CMP_GT_OQ))));
            const __m256i order = _mm256_cvtepu8_epi32(
                _mm_cvtsi64_si128(static_cast<std::int64_t>(kept_lanes[pattern])));
            _mm256_storeu_ps(&found.x[n], _mm256_permutevar8x32_ps(x, order));
            _mm256_storeu_ps(&found.y[n], _mm256_permutevar8x32_ps(y, order));
            _mm256_storeu_si256(
                reinterpret_cast<__m256i*>(&found.index[n]),
                _mm256_permutevar8x32_epi32(
                    _mm256_load_si256(reinterpret_cast<const __m256i*>(&index_[k])), order));
            n += static_cast<unsigned>(std::popcount(pattern));
        }
        found.count = n;
        return n < most_neighbours;
    }
#endif

  private:
    /// Three times the density of a sane cloud.
    static constexpr std::size_t most = 192;

    /// The particles from `first` to before `last`, relative to `centre`.
    bool add(const Particles& particles, std::size_t first, std::size_t last, Vec2 centre) {
        if (count_ + (last - first) > most) {
            return false;
        }
        std::size_t n = count_;
        for (std::size_t b = first; b < last; ++b, ++n) {
            x_[n] = static_cast<float>(particles.x[b] - centre.x);
            y_[n] = static_cast<float>(particles.y[b] - centre.y);
            index_[n] = static_cast<std::uint32_t>(b);
        }
        count_ = n;
        return true;
    }

#ifdef __AVX2__
    /// For each of the 256 patterns of kept lanes, the lanes in order, a byte each.
    static constexpr std::array<std::uint64_t, 256> kept_lanes = [] {
        std::array<std::uint64_t, 256> lanes{};
        for (unsigned pattern = 0; pattern < 256; ++pattern) {
            unsigned n = 0;
            for (std::uint64_t lane = 0; lane < 8; ++lane) {
                if (pattern >> lane & 1) {
                    lanes[pattern] |= lane << (8 * n++);
                }
            }
        }
        return lanes;
    }();
#endif

    Vec2 centre_;
    std::size_t count_ = 0;
    alignas(32) std::array<float, most + eight> x_, y_;
    alignas(32) std::array<std::uint32_t, most + eight> index_;
};

} // namespace duet::fluid
