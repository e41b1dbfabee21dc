// The source paper's formulation: cubic spline, summation forms, pair sums with ghosts for force
// and heat at the walls. The baseline beside which the consistent one is measured; it shares
// particles, neighbours, ghosts and stepping with it. Each term is a function beside its equation.

#pragma once

#include "fluid_solver/boundary.hpp"
#include "fluid_solver/ghosts.hpp"
#include "fluid_solver/hydrostatics.hpp"
#include "fluid_solver/neighbours.hpp"
#include "fluid_solver/particles.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace duet::fluid::paper {

constexpr double smoothing_length_in_spacings = 1.2;
constexpr double shift_strength = 0.1; ///< beta of (43); the paper takes 0.05 to 0.2

/// Cubic spline of support 2h: (1/r) dW/dr, so that grad W = F x.
inline double slope_over_r(double r, double h) {
    const double s = r / h, scale = 10 / (7 * std::numbers::pi * h * h * h * h);
    return s < 1 ? scale * (2.25 * s - 3) : s < 2 ? -0.75 * scale * (2 - s) * (2 - s) / s : 0;
}

/// Two particles as a term sees them; b may be a ghost. x = x_a - x_b, F the kernel's slope_over_r.
struct Pair {
    Vec2 x;
    double F, mass; ///< kg/m, of b
    double density_a, density_b;
    double eta2; ///< (0.1 h)^2
};

/// (38): rho_a (m_b/rho_b) (v_a - v_b) . gradW, by the corrected gradient times m_b/rho_b.
inline double density_rate(double density_a, Vec2 v_ab, Vec2 gradient) {
    return density_a * dot(v_ab, gradient);
}

/// (40), first sum: -m_b (p_a/rho_a^2 + p_b/rho_b^2) gradW, by the corrected gradient.
inline Vec2 pressure_acceleration(const Pair& p, double p_a, double p_b, Vec2 gradient) {
    return -p.mass * (p_a / (p.density_a * p.density_a) + p_b / (p.density_b * p.density_b))
           * gradient;
}

/// (39): 4 m_b nu x.gradW / ((rho_a + rho_b)(r^2 + eta^2)) (v_a - v_b).
inline Vec2 viscous_acceleration(const Pair& p, double viscosity, Vec2 v_ab) {
    const double r2 = dot(p.x, p.x);
    return (4 * p.mass * viscosity * p.F * r2 / ((p.density_a + p.density_b) * (r2 + p.eta2)))
           * v_ab;
}

/// (41) times c: 4 m_b k^2/(rho_a rho_b 2k) (T_a - T_b) x.gradW/(r^2 + eta^2). The 1/rho_a that
/// stands before the printed sum is one too many: units and Cleary's form have none.
inline double heating(const Pair& p, double conductivity, double T_ab) {
    const double r2 = dot(p.x, p.x);
    return 2 * p.mass * conductivity * p.F * r2 / (p.density_a * p.density_b * (r2 + p.eta2))
           * T_ab;
}

/// (50), and alike for the velocity: the value of a ghost at d2 behind a wall of value f_w.
template <class Value>
Value ghost_value(Value f_w, Value f_a, double d2, double d1) {
    return f_w + (d2 / d1) * (f_w - f_a);
}

/// (43) without r_o^2 U dt: x_ab/|x_ab|^3 (m_b/m_a).
inline Vec2 shift_term(Vec2 x, double mass_ratio) {
    const double r2 = dot(x, x);
    return (mass_ratio / (r2 * std::sqrt(r2))) * x;
}

struct Material {
    double density, viscosity, conductivity, heat_capacity, sound_speed;
};

/// What one particle gives to one wall cell: (48), (49), (52), exactly the opposite of what the
/// pair sum over the cell's ghosts gave the particle.
struct WallTransfer {
    std::uint32_t particle, cell;
    Vec2 force;       ///< N/m, on the wall
    double heat_flow; ///< W/m, into the fluid
};

class Rates {
  public:
    Rates(double spacing, int threads);

    /// Accelerations, heating, shift and wall transfers of the sorted particles. `body_force` by
    /// particle beside the buoyancy, or empty.
    void run(const Particles& particles,
             const CellGrid& grid,
             const Boundary& boundary,
             const Ghosts& ghosts,
             const Hydrostatics& hydrostatics,
             const Material& material,
             double volume,
             std::span<const Vec2> body_force);

    /// dp/dt = c^2 drho/dt (42) of all particles, with the velocities of now and the neighbours of
    /// the last run().
    void compress(const Particles& particles, const Material& material);

    std::vector<Vec2> acceleration;    ///< m/s2
    std::vector<double> heating;       ///< K/s
    std::vector<Vec2> shift;           ///< 1: to be multiplied by beta r_o^2 U dt (43)
    std::vector<double> mean_distance; ///< r_o (44), m
    std::vector<double> pressure_rate; ///< Pa/s
    std::vector<std::vector<WallTransfer>> transfers; ///< by chunk

    double support() const { return 2 * smoothing_length_; }

  private:
    /// What compress() needs of a pair: the corrected gradient times m_b/rho_b; of a ghost, whose
    /// velocity differs from the particle's by 1 + d2/d1 times as much as the wall's, times that.
    struct Kept {
        std::uint32_t particle, neighbour; ///< `neighbour` is none for a ghost
        Vec2 gradient;
        Vec2 wall_velocity;
    };

    double smoothing_length_;
    int threads_;
    std::vector<std::vector<Kept>> kept_; ///< by chunk
};

} // namespace duet::fluid::paper
