// The particles, sorted by the cells of a background grid.

#pragma once

#include "fluid_solver/lanes.hpp"
#include "fluid_solver/vector.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace duet::fluid {

/// A grid of square cells over a rectangle, with a border of one empty cell all round.
class CellGrid {
  public:
    CellGrid() = default;
    CellGrid(Vec2 lower, Vec2 upper, double cell);

    int column(double x) const { return clamp((x - origin_.x) * inverse_, columns_); }
    int row(double y) const { return clamp((y - origin_.y) * inverse_, rows_); }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_)
               + static_cast<std::size_t>(column);
    }
    std::size_t index(Vec2 x) const { return index(column(x.x), row(x.y)); }
    Vec2 centre(int column, int row) const {
        return {origin_.x + (column + 0.5) * cell_, origin_.y + (row + 0.5) * cell_};
    }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    double cell() const { return cell_; }
    std::size_t size() const { return index(0, rows_); }

  private:
    /// The border cells stay empty: what lies outside is counted with the nearest inner cell.
    static int clamp(double scaled, int count) {
        const int i = static_cast<int>(scaled);
        return i < 1 ? 1 : (i > count - 2 ? count - 2 : i);
    }

    Vec2 origin_;
    double cell_ = 1, inverse_ = 1;
    int columns_ = 0, rows_ = 0;
};

class Fluid;

/// Structure of arrays; the fields u, v, p, T of one particle lie side by side.
class Particles {
  public:
    std::vector<double> x, y;
    std::vector<Fields> fields;
    std::vector<std::uint32_t> identity;    ///< constant through a run
    std::vector<std::uint16_t> compartment; ///< of the fluid's connected parts

    std::size_t size() const { return x.size(); }
    Vec2 position(std::size_t i) const { return {x[i], y[i]}; }
    void resize(std::size_t n);

    /// Sorts by cell, keeping the order within a cell. O(n); allocates only at the first call.
    void sort(const CellGrid& grid);

    /// First particle of each cell after sort(); grid.size() + 1 entries.
    const std::vector<std::uint32_t>& cell_start() const { return cell_start_; }

  private:
    friend class Fluid; // which saves and restores the order

    std::vector<std::uint32_t> cell_, cell_start_, target_;
    std::vector<double> spare_;
    std::vector<Fields> spare_fields_;
    std::vector<std::uint32_t> spare_identity_;
    std::vector<std::uint16_t> spare_compartment_;
};

} // namespace duet::fluid
