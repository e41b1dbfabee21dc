#include "fluid_solver/closure.hpp"

namespace duet::fluid {

ClosureParts Closure::balance(const Particles& particles,
                              const Evaluation& evaluation,
                              double step,
                              const std::vector<double>& passed) {
    const std::size_t n = particles.size();
    sums_.assign(chunks_of(n) * compartments_, {});
    for_chunks(n, threads_, [&](std::size_t c, std::size_t first, std::size_t last) {
        for (std::size_t a = first; a < last; ++a) {
            Sums& s = sums_[c * compartments_ + particles.compartment[a]];
            const double gain = gained_by_shift(evaluation, a);
            const double weight = std::abs(evaluation.heating[a]);
            s.particles += 1;
            s.heating += evaluation.heating[a];
            s.weight_all += weight;
            s.weight_heated += evaluation.near_heated[a] ? weight : 0;
            s.shifted += gain;
            s.weight_shift += std::abs(gain);
        }
    });

    ClosureParts parts;
    shares_.assign(compartments_, {});
    for (std::size_t k = 0; k < compartments_; ++k) {
        Sums total;
        for (std::size_t c = 0; c < chunks_of(n); ++c) {
            const Sums& s = sums_[c * compartments_ + k];
            total.particles += s.particles;
            total.heating += s.heating;
            total.weight_all += s.weight_all;
            total.weight_heated += s.weight_heated;
            total.shifted += s.shifted;
            total.weight_shift += s.weight_shift;
        }
        const double conduction = passed[k] - step * total.heating;
        Share& share = shares_[k];
        if (total.weight_heated > 0) {
            share.heated = conduction / total.weight_heated;
        } else if (total.weight_all > 0) {
            share.all = conduction / total.weight_all;
        } else {
            share.even += conduction / total.particles;
        }
        if (total.weight_shift > 0) {
            share.shift = -total.shifted / total.weight_shift;
        }
        parts.conduction += conduction;
        parts.shift -= total.shifted;
        parts.conduction_abs += std::abs(conduction);
        parts.shift_abs += std::abs(total.shifted);
    }
    return parts;
}

} // namespace duet::fluid
