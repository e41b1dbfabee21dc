// The level of the pressure, the extremes of the flow, and the speed of sound that follows them.

#include "fluid_solver/implementation.hpp"

#include <algorithm>
#include <cmath>

namespace duet::fluid {

/// In a closed cavity the pressure is defined up to a constant: finds its mean in each compartment,
/// which measure() takes out, and the levels of the hydrostatic part.
void Fluid::Implementation::level() {
    const std::size_t n = particles.size();
    means_.assign(chunks_of(n) * compartments, Lanes{});
    if (config.pressure_level == PressureLevel::free) {
        return;
    }
    for_chunks(n, config.threads, [&](std::size_t c, std::size_t first, std::size_t last) {
        for (std::size_t a = first; a < last; ++a) {
            const Fields& f = particles.fields[a];
            means_[c * compartments + particles.compartment[a]] +=
                Lanes{f.p, f.T, particles.x[a], particles.y[a]};
        }
    });
    // The first chunk's place takes the means: sums over the chunks, in their order.
    for (std::size_t k = 0; k < compartments; ++k) {
        for (std::size_t c = 1; c < chunks_of(n); ++c) {
            means_[k] += means_[c * compartments + k];
        }
        means_[k] /= compartment_size_[k];
        if (buoyant_ && !paper_) { // the paper's pressure is the whole one
            const double mean = means_[k][1], reference = config.reference_temperature;
            hydrostatics_.levels[k] = {
                {config.periodic.x ? reference : mean, config.periodic.y ? reference : mean},
                {means_[k][2], means_[k][3]}};
        }
    }
}

/// Takes the mean that level() has found out of the pressure, and finds the extremes.
void Fluid::Implementation::measure() {
    const std::size_t n = particles.size();
    extremes_.resize(chunks_of(n));
    for_chunks(n, config.threads, [&](std::size_t c, std::size_t first, std::size_t last) {
        Extremes e;
        for (std::size_t a = first; a < last; ++a) {
            Fields& f = particles.fields[a];
            f.p -= means_[particles.compartment[a]][0];
            e.speed2 = std::max(e.speed2, f.u * f.u + f.v * f.v);
            e.lowest = std::min(e.lowest, f.p);
            e.highest = std::max(e.highest, f.p);
            e.body_force += norm(hydrostatics_.departure(f.T, particles.compartment[a])
                                 + (forced_ ? given_force_[a] : Vec2{}));
            e.lost +=
                std::isfinite(f.u + f.v + f.p + f.T + particles.x[a] + particles.y[a]) ? 0 : 1;
        }
        extremes_[c] = e;
    });
    means_.assign(compartments, Lanes{});
    Extremes e = extremes_[0];
    for (std::size_t c = 1; c < extremes_.size(); ++c) {
        const Extremes& other = extremes_[c];
        e = {std::max(e.speed2, other.speed2),
             std::min(e.lowest, other.lowest),
             std::max(e.highest, other.highest),
             e.body_force + other.body_force,
             e.lost + other.lost};
    }
    speed_ = std::sqrt(e.speed2);
    pressure_range_ = e.highest - e.lowest;
    body_force_ = e.body_force / static_cast<double>(n);
    const double limit = sound_speed_ > 0 ? 2 * sound_speed_ : speed_;
    if (e.lost > 0 || !(speed_ <= limit)) {
        std::size_t worst = 0;
        for (std::size_t a = 0; a < n; ++a) {
            const Fields& f = particles.fields[a];
            if (!(f.u * f.u + f.v * f.v < e.speed2)) {
                worst = a;
                break;
            }
        }
        throw Diverged("the fluid diverged after t = " + std::to_string(time) + " s near ("
                       + std::to_string(particles.x[worst]) + ", "
                       + std::to_string(particles.y[worst]) + "): speed " + std::to_string(speed_)
                       + " m/s at a sound speed of " + std::to_string(sound_speed_) + " m/s, "
                       + std::to_string(e.lost)
                       + " particles not finite; refine the spacing, shorten the window, or raise "
                         "the sound speed");
    }
}

/// c from the flow and the pressure head: c >= 10 U, c^2 >= 10 dp/rho, c^2 >= 100 |b| dx, c >=
/// nu/dx; rises at once and falls slowly, so that single peaks do not shake it.
void Fluid::Implementation::adapt_sound_speed() {
    if (config.sound_speed > 0) {
        sound_speed_ = config.sound_speed;
        return;
    }
    const double dx = config.spacing;
    const double head = body_force_ * dx;
    const double viscous = config.kinematic_viscosity / dx;
    const double wanted = std::max({10 * fastest(),
                                    std::sqrt(10 * pressure_range_ / config.density),
                                    10 * std::sqrt(head),
                                    viscous});
    sound_speed_ = std::max(wanted, 0.99 * sound_speed_);
    if (paper_ && !(sound_speed_ > 0)) { // its density is rho0 + p/c^2
        throw SceneError("the paper's formulation needs a speed of sound, and nothing in this "
                         "scene sets one; give fluid.sound_speed");
    }
}

/// Largest speed of the flow, which from rest is that of the walls and bodies that will drive it.
double Fluid::Implementation::fastest() const {
    return std::max(speed_, boundary_.speed());
}

} // namespace duet::fluid
