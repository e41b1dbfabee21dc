// The inner steps: velocity and pressure with the acoustic time step, everything else frozen
// (docs/theory-fluid.md, "Pressure"). In single precision; what they add over one outer step
// is added to the particles' double-precision fields.

#pragma once

#include "fluid_solver/evaluation.hpp"
#include "fluid_solver/hydrostatics.hpp"

#include <vector>

namespace duet::fluid {

/// Parameters of a group of inner steps.
struct InnerSteps {
    int count = 1;
    double step = 0;        ///< s
    double density = 0;     ///< kg/m3
    double sound_speed = 0; ///< m/s
    const Hydrostatics* hydrostatics = nullptr;
    double smoothing_length = 0;
    double smoothness = 1;             ///< of the flow: the share of its turning that counts
    std::span<const Vec2> given_force; ///< m/s2, by particle, buoyancy apart; or empty
};

/// What body forces and the viscous term gave to the particles in a group of inner steps, for a
/// mass of one each: impulses, m/s, and works by the mean of the velocities before and after.
struct Booked {
    Vec2 impulse;                                 ///< of buoyancy and given force
    double body_force_work = 0, viscous_work = 0; ///< m2/s2

    Booked& operator+=(const Booked& o) {
        impulse += o.impulse;
        body_force_work += o.body_force_work;
        viscous_work += o.viscous_work;
        return *this;
    }
};

class Pressure {
  public:
    explicit Pressure(int threads) : threads_(threads) {}

    /// Advances u, v, p and P of the particles by `count` steps and leaves the last gradient of p
    /// in the evaluation's slopes. With Buoyancy the body force follows T + t dT/dt. Returns the
    /// sums over the particles.
    template <bool Buoyancy>
    Booked run(Particles& particles, Evaluation& evaluation, const InnerSteps& inner);

  private:
    /// Velocity and gradient of p of one particle, gathered together.
    struct alignas(16) Flow {
        float u, v, px, py;
    };
    /// dv/dt without the pressure at the start, and its rate of change.
    struct alignas(16) Drive {
        float x, y, rate_x, rate_y;
    };

    /// What the pressure's equation takes of the inner steps.
    struct Compression {
        float stiffness; ///< rho c^2, Pa
        float diffusion; ///< delta h c, m2/s
        float step;      ///< s
        float kept;      ///< what a step leaves of P, 1/(1 + dt/tau)
        float ahead = 0; ///< s, of the new velocities before the places: t - t_mid
    };

    template <bool Buoyancy>
    void accelerate(const Particles& particles,
                    const Evaluation& evaluation,
                    const InnerSteps& inner,
                    double time,
                    std::size_t a);
    void compress(const Evaluation& evaluation,
                  const Compression& terms,
                  float& relaxing,
                  std::size_t a);

    int threads_;
    std::vector<Flow> flow_;
    std::vector<Drive> drive_;
    std::vector<float> p_, next_p_;
    std::vector<Booked> booked_;   ///< by chunk
    std::vector<float> turning_;   ///< -2 det grad v, 1/s2, as far as the flow is smooth
    std::vector<float> curvature_; ///< sum V F (p_a - p_b)
};

} // namespace duet::fluid
