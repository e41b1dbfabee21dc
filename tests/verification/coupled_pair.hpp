// Both cores in one process, coupled window by window as the protocol does it with the fluid first:
// the fluid advances in the predicted motion, the solid under the loads of the same window.

#pragma once

#include "fluid_solver/fluid.hpp"
#include "solid_solver/solid.hpp"

#include <algorithm>
#include <vector>

namespace duet::test {

class Pair {
  public:
    /// The solid's wet boundary becomes the fluid's interface.
    Pair(const fluid::Config& config, std::vector<solid::BodyConfig> bodies)
        : solid_(std::move(bodies), region_of(config)), latest_(state()), before_(latest_),
          fluid_(config, chains(), latest_) {}

    solid::Solid& solid() { return solid_; }
    fluid::Fluid& fluid() { return fluid_; }
    double time() const { return time_; }

    /// To be called when the state of a body was set from outside, before the first window.
    void refresh() { latest_ = before_ = state(); }

    /// One window; 0: as long as the fluid's own step.
    void advance(double window = 0) {
        const double w = window > 0 ? window : fluid_.stable_step();
        fluid_.advance(w, latest_, predicted(w));
        std::vector<double> force, heat_flow;
        for (const fluid::Vec2 impulse : fluid_.passed().impulse) {
            force.push_back(impulse.x / w);
            force.push_back(impulse.y / w);
        }
        for (const double heat : fluid_.passed().heat) {
            heat_flow.push_back(heat / w);
        }
        solid_.advance(w, force, heat_flow);
        before_ = latest_;
        latest_ = state();
        last_window_ = w;
        time_ += w;
    }

    /// Windows of the fluid's own step, the last of them shorter, so that `end` is met.
    void advance_to(double end) {
        while (time_ < end * (1 - 1e-12)) {
            const double left = end - time_, step = fluid_.stable_step();
            advance(left <= step ? left : std::min(step, 0.5 * left));
        }
    }

  private:
    static std::vector<solid::Point> region_of(const fluid::Config& config) {
        std::vector<solid::Point> corners;
        for (const fluid::Vec2 c : config.region) {
            corners.emplace_back(c.x, c.y);
        }
        return corners;
    }

    std::vector<fluid::Chain> chains() const {
        std::vector<fluid::Chain> all;
        for (const auto& chain : solid_.interface().chain) {
            all.push_back({chain.node, chain.closed});
        }
        return all;
    }

    fluid::InterfaceState state() const {
        std::vector<double> x, v;
        fluid::InterfaceState now;
        solid_.interface_state(x, v, now.temperature);
        for (std::size_t i = 0; i < now.temperature.size(); ++i) {
            now.position.push_back({x[2 * i], x[2 * i + 1]});
            now.velocity.push_back({v[2 * i], v[2 * i + 1]});
        }
        return now;
    }

    fluid::InterfaceState predicted(double w) const {
        fluid::InterfaceState end = latest_;
        const double per_span = last_window_ > 0 ? 1 / last_window_ : 0;
        for (std::size_t i = 0; i < end.position.size(); ++i) {
            const fluid::Vec2 a = per_span * (latest_.velocity[i] - before_.velocity[i]);
            end.position[i] += w * latest_.velocity[i] + 0.5 * w * w * a;
            end.velocity[i] += w * a;
            end.temperature[i] += w * per_span * (latest_.temperature[i] - before_.temperature[i]);
        }
        return end;
    }

    solid::Solid solid_;
    double time_ = 0, last_window_ = 0;
    fluid::InterfaceState latest_, before_;
    fluid::Fluid fluid_;
};

} // namespace duet::test
