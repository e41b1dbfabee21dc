// Closes the energy balance of every outer step exactly, in two parts (docs/theory-fluid.md,
// "Closure").

#pragma once

#include "fluid_solver/evaluation.hpp"
#include "fluid_solver/particles.hpp"

#include <cmath>
#include <vector>

namespace duet::fluid {

/// What the closure gave back in one step, in kelvin times particles.
struct ClosureParts {
    double conduction = 0;                    ///< wall estimate minus Laplacian
    double shift = 0;                         ///< minus what the correction after the shift gave
    double conduction_abs = 0, shift_abs = 0; ///< absolute values, summed over the compartments
};

class Closure {
  public:
    Closure(std::size_t compartments, int threads)
        : compartments_(compartments), threads_(threads) {}

    /// Finds what closes T += step dT/dt + dr.grad T, so that in each compartment the sum of T over
    /// the particles grows by `passed` (kelvin times particles) to rounding:
    ///  (i) passed - sum step dT/dt goes to the particles within the support of heated walls,
    ///      weighted by |dT/dt|;
    /// (ii) -sum dr.grad T goes to all, weighted by |dr.grad T|.
    /// Where all weights vanish a part is spread evenly.
    ClosureParts balance(const Particles& particles,
                         const Evaluation& evaluation,
                         double step,
                         const std::vector<double>& passed);

    /// Advances the temperature of the particle a, after balance().
    void advance_temperature(Particles& particles,
                             const Evaluation& evaluation,
                             double step,
                             std::size_t a) const {
        const Share& share = shares_[particles.compartment[a]];
        const double heating = evaluation.heating[a], weight = std::abs(heating);
        const double gain = gained_by_shift(evaluation, a);
        particles.rate[a].T = recent(particles.rate[a].T, heating);
        particles.fields[a].T += step * heating + gain + share.all * weight
                                 + (evaluation.near_heated[a] ? share.heated * weight : 0)
                                 + share.shift * std::abs(gain) + share.even;
    }

  private:
    /// Sums over one chunk or compartment.
    struct Sums {
        double particles = 0;
        double heating = 0, weight_all = 0, weight_heated = 0;
        double shifted = 0, weight_shift = 0;
    };
    /// What each particle receives for its weight, and evenly.
    struct Share {
        double heated = 0, all = 0, shift = 0, even = 0;
    };

    static double gained_by_shift(const Evaluation& evaluation, std::size_t a) {
        const Vec2 dr = evaluation.shift[a];
        return dr.x * evaluation.slope_x[a].T + dr.y * evaluation.slope_y[a].T;
    }

    std::size_t compartments_;
    int threads_;
    std::vector<Sums> sums_; ///< by chunk and compartment
    std::vector<Share> shares_;
};

} // namespace duet::fluid
