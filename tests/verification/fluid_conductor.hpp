// A rectangular conductor on a square grid of nodes, explicit finite differences: the partner of
// the fluid where only conjugate heat is verified.

#pragma once

#include "fluid_solver/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace duet::fluid::test {

class Conductor {
  public:
    /// corner, columns x rows cells of side `cell`; capacity rho c, conductivity k.
    Conductor(Vec2 corner,
              std::size_t columns,
              std::size_t rows,
              double cell,
              double capacity,
              double conductivity,
              double temperature)
        : corner_(corner), columns_(columns), rows_(rows), cell_(cell), capacity_(capacity),
          conductivity_(conductivity), T_((columns + 1) * (rows + 1), temperature),
          rate_(T_.size()) {}

    std::size_t node(std::size_t i, std::size_t j) const { return j * (columns_ + 1) + i; }
    Vec2 position(std::size_t node) const {
        const std::size_t i = node % (columns_ + 1), j = node / (columns_ + 1);
        return corner_ + Vec2{static_cast<double>(i) * cell_, static_cast<double>(j) * cell_};
    }
    double temperature(std::size_t node) const { return T_[node]; }

    /// Thermal energy, J/m.
    double heat() const {
        double sum = 0;
        for (std::size_t n = 0; n < T_.size(); ++n) {
            sum += capacity_ * area(n) * T_[n];
        }
        return sum;
    }

    /// The chain of all four sides, counter-clockwise.
    std::vector<std::size_t> ring() const {
        std::vector<std::size_t> nodes;
        for (std::size_t i = 0; i < columns_; ++i) {
            nodes.push_back(node(i, 0));
        }
        for (std::size_t j = 0; j < rows_; ++j) {
            nodes.push_back(node(columns_, j));
        }
        for (std::size_t i = columns_; i > 0; --i) {
            nodes.push_back(node(i, rows_));
        }
        for (std::size_t j = rows_; j > 0; --j) {
            nodes.push_back(node(0, j));
        }
        return nodes;
    }

    /// The interface's state with the wet nodes in this order.
    InterfaceState state(const std::vector<std::size_t>& wet) const {
        InterfaceState s;
        for (const std::size_t n : wet) {
            s.position.push_back(position(n));
            s.velocity.push_back({});
            s.temperature.push_back(T_[n]);
        }
        return s;
    }

    /// Advances by `window` with `heat` (J/m by segment) entering evenly in time, half at each end
    /// of a segment. The stable step dx^2 rho c/(4 k) is kept.
    void advance(double window,
                 const std::vector<std::size_t>& wet,
                 bool closed,
                 const std::vector<double>& heat) {
        const double stable = 0.2 * cell_ * cell_ * capacity_ / conductivity_;
        const int steps = std::max(1, static_cast<int>(std::ceil(window / stable)));
        for (int step = 0; step < steps; ++step) {
            conduct();
            for (std::size_t s = 0; s < wet.size() - (closed ? 0 : 1); ++s) {
                rate_[wet[s]] += heat[s] / (2 * window);
                rate_[wet[(s + 1) % wet.size()]] += heat[s] / (2 * window);
            }
            for (std::size_t n = 0; n < T_.size(); ++n) {
                T_[n] += window / steps * rate_[n] / (capacity_ * area(n));
            }
        }
    }

  private:
    bool outermost(std::size_t i, std::size_t last) const { return i == 0 || i == last; }
    double area(std::size_t n) const {
        const double x = outermost(n % (columns_ + 1), columns_) ? 0.5 : 1;
        const double y = outermost(n / (columns_ + 1), rows_) ? 0.5 : 1;
        return x * y * cell_ * cell_;
    }
    void conduct() {
        std::fill(rate_.begin(), rate_.end(), 0.0);
        const auto exchange = [&](std::size_t a, std::size_t b, double width) {
            const double q = width * conductivity_ * (T_[a] - T_[b]);
            rate_[a] -= q;
            rate_[b] += q;
        };
        for (std::size_t j = 0; j <= rows_; ++j) {
            for (std::size_t i = 0; i <= columns_; ++i) {
                if (i < columns_) {
                    exchange(node(i, j), node(i + 1, j), outermost(j, rows_) ? 0.5 : 1);
                }
                if (j < rows_) {
                    exchange(node(i, j), node(i, j + 1), outermost(i, columns_) ? 0.5 : 1);
                }
            }
        }
    }

    Vec2 corner_;
    std::size_t columns_, rows_;
    double cell_, capacity_, conductivity_;
    std::vector<double> T_, rate_;
};

/// One open or closed chain over `count` nodes.
inline Chain chain_of(std::size_t count, bool closed) {
    Chain chain;
    chain.closed = closed;
    for (std::uint32_t i = 0; i < count; ++i) {
        chain.nodes.push_back(i);
    }
    return chain;
}

} // namespace duet::fluid::test
