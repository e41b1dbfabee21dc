// The largest eigenvalue of M^-1 K by Lanczos' method: what the stable explicit step follows from.

#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace duet::solid {

class Spectrum {
  public:
    /// y = K x, K symmetric and not negative.
    using Operator = std::function<void(std::span<const double> x, std::span<double> y)>;

    /// Starts from a fixed pattern that no mesh's mode is orthogonal to.
    explicit Spectrum(std::size_t unknowns) : mode_(unknowns) {
        std::uint64_t state = 0x9E3779B97F4A7C15u;
        for (double& value : mode_) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            value = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
        }
    }

    /// Largest eigenvalue of M^-1 K; `inverse` is the diagonal of M^-1, zero where an unknown is
    /// held. Goes on from the mode found before. Returns the largest Ritz value and the norm of its
    /// residual: there is an eigenvalue between their difference and their sum, of which the sum is
    /// returned. Ends when the residual is less than `tolerance` of the value, or after `most`
    /// products with K.
    double largest(const Operator& stiffness,
                   std::span<const double> inverse,
                   int most = 100,
                   double tolerance = 2e-3);

    std::vector<double>& mode() { return mode_; }

  private:
    std::vector<double> mode_;
};

} // namespace duet::solid
