#include "fluid_solver/pressure.hpp"

namespace duet::fluid {

namespace {

using Pair = double __attribute__((vector_size(16)));
using Quad = double __attribute__((vector_size(32)));

constexpr double diffusion = 0.1; ///< delta of the pressure's diffusion

} // namespace

/// grad p_a = L [ sum w (p_b - p_a) + sum_k N_k rho (b_a - a_wall).n_k ],
/// dv/dt = -grad p / rho + viscous + b.
template <bool Buoyancy>
void Pressure::accelerate(const Particles& particles,
                          const Evaluation& evaluation,
                          const InnerSteps& inner,
                          double time,
                          std::size_t a) {
    const PairWeight* pair = evaluation.pairs(a);
    const double pa = p_[a];
    double rx = 0, ry = 0;
    for (std::size_t k = 0; k < evaluation.count[a]; ++k) {
        const double difference = p_[pair[k].index] - pa;
        rx += static_cast<double>(pair[k].x) * difference;
        ry += static_cast<double>(pair[k].y) * difference;
    }
    Vec2 b;
    if constexpr (Buoyancy) {
        const double T = particles.fields[a].T + time * evaluation.heating[a];
        b = inner.hydrostatics->departure(T, particles.compartment[a]);
    }
    Vec2 gradient = evaluation.L[a] * Vec2{rx, ry};
    if (evaluation.near_wall[a]) {
        const WallTerms& wall = evaluation.wall[a];
        gradient += inner.density * (wall.L_N_n * b - wall.L_N_acceleration);
    }
    const Vec2 dv = inner.step * (evaluation.viscous[a] + b - (1 / inner.density) * gradient);
    Flow& flow = flow_[a];
    flow.u += dv.x;
    flow.v += dv.y;
    flow.px = gradient.x;
    flow.py = gradient.y;
}

/// dp/dt = -rho c^2 div v + v.grad p + delta h c psi,
/// psi = sum 2 V F [ (p_a - p_b) - (grad p_a + grad p_b).x_ab / 2 ].
void Pressure::compress(const Evaluation& evaluation, const InnerSteps& inner, std::size_t a) {
    const PairWeight* pair = evaluation.pairs(a);
    const Flow& own = flow_[a];
    const Quad mine{own.u, own.v, own.px, own.py};
    const double pa = p_[a];
    Quad straight{}; // sum w_x du, w_y dv, w_x dp_x, w_y dp_y
    Pair across{};   // sum w_y du, w_x dv
    Pair w_sum{};
    double curvature = 0; // sum V F (p_a - p_b)
    for (std::size_t k = 0; k < evaluation.count[a]; ++k) {
        const Flow& other = flow_[pair[k].index];
        const double wx = pair[k].x, wy = pair[k].y;
        const Quad difference = Quad{other.u, other.v, other.px, other.py} - mine;
        straight += Quad{wx, wy, wx, wy} * difference;
        across += Pair{wy, wx} * Pair{difference[0], difference[1]};
        w_sum += Pair{wx, wy};
        curvature += static_cast<double>(pair[k].F) * (pa - p_[pair[k].index]);
    }
    const bool walled = evaluation.near_wall[a];
    const Mat2& L = walled ? evaluation.wall[a].L_velocity : evaluation.L[a];
    double divergence =
        L.xx * straight[0] + L.xy * across[0] + L.yx * across[1] + L.yy * straight[1];
    if (walled) {
        const WallTerms& wall = evaluation.wall[a];
        divergence += wall.value - (own.u * wall.L_S.x + own.v * wall.L_S.y);
    }
    const double psi =
        2 * curvature - (straight[2] + straight[3]) - 2 * (w_sum[0] * own.px + w_sum[1] * own.py);
    const double c = inner.sound_speed;
    next_p_[a] = pa
                 + inner.step
                       * (-inner.density * c * c * divergence + own.u * own.px + own.v * own.py
                          + diffusion * inner.smoothing_length * c * psi);
}

template <bool Buoyancy>
void Pressure::run(Particles& particles, Evaluation& evaluation, const InnerSteps& inner) {
    const std::size_t n = particles.size();
    flow_.resize(n);
    p_.resize(n);
    next_p_.resize(n);
    for_particles(n, threads_, [&](std::size_t a) {
        const Fields& f = particles.fields[a];
        flow_[a] = {f.u, f.v, 0, 0};
        p_[a] = f.p;
    });
    for (int s = 0; s < inner.count; ++s) {
        const double time = s * inner.step;
        for_particles(n, threads_, [&](std::size_t a) {
            accelerate<Buoyancy>(particles, evaluation, inner, time, a);
        });
        for_particles(n, threads_, [&](std::size_t a) { compress(evaluation, inner, a); });
        p_.swap(next_p_);
    }
    for_particles(n, threads_, [&](std::size_t a) {
        particles.fields[a] = {flow_[a].u, flow_[a].v, p_[a], particles.fields[a].T};
        evaluation.slope_x[a].p = flow_[a].px;
        evaluation.slope_y[a].p = flow_[a].py;
    });
}

template void Pressure::run<false>(Particles&, Evaluation&, const InnerSteps&);
template void Pressure::run<true>(Particles&, Evaluation&, const InnerSteps&);

} // namespace duet::fluid
