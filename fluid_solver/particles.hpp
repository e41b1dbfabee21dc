// The particles, sorted by the cells of a background grid.

#pragma once

#include "fluid_solver/lanes.hpp"
#include "fluid_solver/vector.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace duet::fluid {

/// A grid of cells over a rectangle, with a border of one empty cell all round. In a periodic
/// direction the rectangle holds whole cells, and beyond its last ones lie the first ones again.
class CellGrid {
  public:
    CellGrid() = default;
    /// Cells are squares of side `cell`, in periodic directions somewhat longer.
    CellGrid(Vec2 lower, Vec2 upper, double cell, Periodic periodic = {});

    int column(double x) const { return clamp((x - origin_.x) * inverse_.x, columns_); }
    int row(double y) const { return clamp((y - origin_.y) * inverse_.y, rows_); }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_)
               + static_cast<std::size_t>(column);
    }
    std::size_t index(Vec2 x) const { return index(column(x.x), row(x.y)); }
    Vec2 centre(int column, int row) const {
        return {origin_.x + (column + 0.5) * cell_.x, origin_.y + (row + 0.5) * cell_.y};
    }
    Vec2 cell() const { return cell_; } ///< its two sides, m
    std::size_t size() const { return index(0, rows_); }

    Vec2 period() const { return period_; } ///< m; 0 in a direction that is not periodic
    bool periodic() const { return period_.x > 0 || period_.y > 0; }
    /// A place up to a period outside, brought back over the periodic sides.
    Vec2 wrapped(Vec2 x) const {
        return {wrap(x.x, lower_.x, period_.x), wrap(x.y, lower_.y, period_.y)};
    }
    /// The same for a place any number of periods away.
    Vec2 home(Vec2 x) const {
        x.x -= period_.x > 0 ? period_.x * std::floor((x.x - lower_.x) / period_.x) : 0;
        x.y -= period_.y > 0 ? period_.y * std::floor((x.y - lower_.y) / period_.y) : 0;
        return wrapped(x); // rounding may leave it on the far side
    }
    /// The shortest of the ways that differ from r by whole periods.
    Vec2 shortest(Vec2 r) const {
        r.x -= period_.x > 0 ? period_.x * std::round(r.x / period_.x) : 0;
        r.y -= period_.y > 0 ? period_.y * std::round(r.y / period_.y) : 0;
        return r;
    }
    /// Whether a cell next to this one lies over a periodic side.
    bool at_seam(int column, int row) const {
        return (period_.x > 0 && (column == 1 || column == columns_ - 2))
               || (period_.y > 0 && (row == 1 || row == rows_ - 2));
    }
    /// What stands for a cell beyond a periodic side: the cell that holds its particles, and how
    /// far they are to be moved to stand there. Any other cell stands for itself.
    struct Image {
        std::size_t cell;
        Vec2 shift;
    };
    Image image(int column, int row) const {
        Vec2 shift;
        const int c = over_seam(column, columns_ - 2, period_.x, shift.x);
        const int r = over_seam(row, rows_ - 2, period_.y, shift.y);
        return {index(c, r), shift};
    }
    /// Calls visit(cell) once for each cell that may hold a particle nearer than `reach` m, at most
    /// two cells, row by row.
    template <class Visit>
    void for_cells_within(Vec2 x, double reach, const Visit& visit) const {
        const auto [low, high] = within(x.y - origin_.y, reach, inverse_.y, rows_, period_.y);
        const auto [from, to] = within(x.x - origin_.x, reach, inverse_.x, columns_, period_.x);
        for (int r = low; r <= high; ++r) {
            for (int c = from; c <= to; ++c) {
                visit(image(c, r).cell);
            }
        }
    }

  private:
    /// The border cells stay empty: what lies outside is counted with the nearest inner cell.
    static int clamp(double scaled, int count) {
        const int i = static_cast<int>(scaled);
        return i < 1 ? 1 : (i > count - 2 ? count - 2 : i);
    }
    static double wrap(double x, double lower, double period) {
        return period > 0 ? (x < lower ? x + period : x >= lower + period ? x - period : x) : x;
    }
    /// `inner` cells are numbered from 1.
    static int over_seam(int i, int inner, double period, double& shift) {
        if (period > 0 && (i < 1 || i > inner)) {
            shift = i < 1 ? -period : period;
            return i < 1 ? i + inner : i - inner;
        }
        return i;
    }
    /// The first and the last cell in one direction, each of them once.
    static std::pair<int, int>
    within(double place, double reach, double inverse, int count, double period) {
        if (period > 0) {
            const int first = static_cast<int>(std::floor((place - reach) * inverse));
            const int last = static_cast<int>(std::floor((place + reach) * inverse));
            return {first, std::min(last, first + count - 3)};
        }
        return {clamp((place - reach) * inverse, count), clamp((place + reach) * inverse, count)};
    }

    Vec2 lower_, period_, origin_;
    Vec2 cell_{1, 1}, inverse_{1, 1};
    int columns_ = 0, rows_ = 0;
};

class Fluid;

/// A rate of late: the mean of the one before and the one of this step (docs/theory-fluid.md,
/// "Rates of late").
inline float recent(float before, double now) {
    return static_cast<float>(0.5 * (static_cast<double>(before) + now));
}

/// Structure of arrays; the fields u, v, p, T of one particle lie side by side.
struct ParticleArrays {
    std::vector<double> x, y;
    std::vector<Fields> fields;
    std::vector<float> relaxing;         ///< P, Pa: what the pressure answered of late
    std::vector<Slope> rate;             ///< of u, v (m/s2) and T (K/s), of late
    std::vector<Slope> laplacian;        ///< of u, v, T in the step before, where it is asked for
    std::vector<std::uint32_t> identity; ///< constant through a run
    std::vector<std::uint16_t> compartment; ///< of the fluid's connected parts
};

/// Sorted by the cells of a grid whenever sort() is called.
class Particles : public ParticleArrays {
  public:
    std::size_t size() const { return x.size(); }
    Vec2 position(std::size_t i) const { return {x[i], y[i]}; }
    void resize(std::size_t n);

    /// Sorts by cell, keeping the order within a cell. O(n); allocates only at the first call.
    void sort(const CellGrid& grid, int threads = 1);

    /// First particle of each cell after sort(); grid.size() + 1 entries.
    const std::vector<std::uint32_t>& cell_start() const { return cell_start_; }

  private:
    friend class Fluid; // which saves and restores the order

    template <class Visit>
    void for_arrays(const Visit& visit);

    ParticleArrays spare_;
    std::vector<std::uint32_t> cell_; ///< of each particle, then its place in the new order
    std::vector<std::uint32_t> cell_start_;
    std::vector<std::uint32_t> next_; ///< by range and cell: how many, then where the next one goes
};

} // namespace duet::fluid
