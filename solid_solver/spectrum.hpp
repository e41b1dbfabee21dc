// The largest eigenvalue of M^-1 K by power iteration: what the stable explicit step follows from.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace duet::solid {

class Spectrum {
  public:
    /// y = K x, K symmetric and not negative.
    using Operator = std::function<void(const double* x, double* y)>;

    /// Starts from a fixed pattern that no mesh's mode is orthogonal to.
    explicit Spectrum(std::size_t unknowns) : mode_(unknowns), image_(unknowns) {
        std::uint64_t state = 0x9E3779B97F4A7C15u;
        for (double& value : mode_) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            value = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
        }
    }

    /// Largest eigenvalue of M^-1 K; `inverse` is the diagonal of M^-1, zero where an unknown is
    /// held. Goes on from the mode found before. The Rayleigh quotient approaches the eigenvalue
    /// from below, with the square of the mode's error; the iteration ends when it gains less than
    /// `tolerance` in 10 rounds, or after `most` rounds.
    double largest(const Operator& stiffness,
                   std::span<const double> inverse,
                   int most = 2000,
                   double tolerance = 1e-4);

    std::vector<double>& mode() { return mode_; }

  private:
    std::vector<double> mode_, image_;
};

} // namespace duet::solid
