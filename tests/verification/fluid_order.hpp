// Errors of whole fields, and orders of convergence from errors at three spacings or more.

#pragma once

#include "fluid_solver/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace duet::fluid::test {

/// Root mean square over the particles of |u - exact(x)|, m/s.
template <class Exact>
double velocity_error(const Snapshot& s, const Exact& exact) {
    double squares = 0;
    for (std::size_t i = 0; i < s.position.size(); ++i) {
        const Vec2 error = s.velocity[i] - exact(s.position[i]);
        squares += dot(error, error);
    }
    return std::sqrt(squares / static_cast<double>(s.position.size()));
}

/// The slope of log error against log spacing (least squares) is at least `order`, and the error at
/// the finest spacing at most `ceiling`.
inline void expect_order(const std::vector<double>& spacings,
                         const std::function<double(double)>& error_at,
                         double order,
                         double ceiling) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, last = 0;
    std::string all;
    for (const double spacing : spacings) {
        last = error_at(spacing);
        all += " " + std::to_string(last);
        const double a = std::log(spacing), b = std::log(last);
        n += 1, x += a, y += b, xx += a * a, xy += a * b;
    }
    const double slope = (n * xy - x * y) / (n * xx - x * x);
    testing::Test::RecordProperty("order", std::to_string(slope));
    EXPECT_GE(slope, order) << "errors" << all;
    EXPECT_LE(last, ceiling) << "errors" << all;
}

} // namespace duet::fluid::test
