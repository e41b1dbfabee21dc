// The smoothing kernel: Wendland C2 in two dimensions.

#pragma once

#include <cmath>
#include <numbers>

namespace duet::fluid {

/// Support radius in spacings: 19 neighbours on a square lattice (20 with the corners' rounding).
constexpr double support_in_spacings = 2.6;

/// W(r) = 7/(pi R^2) (1 - r/R)^4 (1 + 4 r/R) for r < R, else 0; its integral over the plane is one.
class Kernel {
  public:
    explicit Kernel(double support)
        : support_(support), inverse_(1 / support),
          value_scale_(7 / (std::numbers::pi * support * support)),
          slope_scale_(-140 / (std::numbers::pi * support * support * support * support)) {}

    double support() const { return support_; }
    /// The smoothing length h = R/2.
    double smoothing_length() const { return support_ / 2; }

    double value(double r) const {
        const double s = 1 - r * inverse_;
        return s > 0 ? value_scale_ * s * s * s * s * (5 - 4 * s) : 0;
    }

    /// F(r) = W'(r)/r = -140/(pi R^4) (1 - r/R)^3, so that grad W = F x; for r < R.
    double slope_over_r(double r) const {
        const double s = 1 - r * inverse_;
        return slope_scale_ * s * s * s;
    }

  private:
    double support_, inverse_, value_scale_, slope_scale_;
};

} // namespace duet::fluid
