// The order of convergence that a series of errors shows.

#pragma once

#include <cmath>
#include <vector>

namespace duet::solid::test {

/// Slope of log2(error) by least squares; each error is of a mesh twice as fine as the one before.
inline double fitted_order(const std::vector<double>& error) {
    const double middle = 0.5 * (static_cast<double>(error.size()) - 1);
    double mean = 0, slope = 0, squares = 0;
    for (const double e : error) {
        mean += std::log2(e) / static_cast<double>(error.size());
    }
    for (std::size_t i = 0; i < error.size(); ++i) {
        const double x = static_cast<double>(i) - middle;
        slope -= x * (std::log2(error[i]) - mean);
        squares += x * x;
    }
    return slope / squares;
}

} // namespace duet::solid::test
