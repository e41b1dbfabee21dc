// Fields known at scattered points, from a file: the state of an earlier run, or a measurement,
// from which a run may start.

#pragma once

#include "fluid_solver/vector.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace duet::fluid {

class ScatteredState {
  public:
    enum Field { temperature, velocity_x, velocity_y }; ///< K, m/s, m/s

    /// A CSV file whose first line that is no comment (#) names its columns, in quotes or not: x
    /// and y (m), and any of the fields by their names above; other columns are left out. Throws
    /// std::invalid_argument with file, line, and what was expected. The points lie in the region
    /// from `lower` to `upper`, which repeats itself along `periodic`.
    explicit ScatteredState(const std::filesystem::path& file,
                            Periodic periodic = {},
                            Vec2 lower = {},
                            Vec2 upper = {});

    bool has(Field field) const { return !values_[field].empty(); }

    /// At x: a plane through the points about it by weighted least squares, exact for linear fields
    /// between their values, which it does not leave; the value of the nearest point if none is
    /// about it.
    double at(Field field, Vec2 x) const;

  private:
    void read(const std::filesystem::path& file);
    void sort(const std::filesystem::path& file);
    void repeat(Periodic periodic, Vec2 lower, Vec2 upper);
    double nearest(Field field, Vec2 x) const;
    int column(double x) const;
    int row(double y) const;

    std::vector<Vec2> points_;
    std::array<std::vector<double>, 3> values_;
    Vec2 lower_;
    double cell_ = 1; ///< holds two to three points on average
    int columns_ = 1, rows_ = 1;
    std::vector<std::uint32_t> start_, order_; ///< points by cell
};

} // namespace duet::fluid
