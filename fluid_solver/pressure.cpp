#include "fluid_solver/pressure.hpp"

namespace duet::fluid {

namespace {

constexpr double diffusion = 0.1; ///< delta of the pressure's diffusion
constexpr float share = 0.5F;     ///< phi: of the pressure's answer, what relaxes
constexpr double relaxation = 6;  ///< its time, in h/c

} // namespace

/// grad p_a = L [ sum w (p_b - p_a) + sum_k N_k rho (b_a - a_wall).n_k ],
/// dv/dt = -grad p / rho + viscous + b; and sum V F (p_a - p_b) for compress().
template <bool Buoyancy>
void Pressure::accelerate(const Particles& particles,
                          const Evaluation& evaluation,
                          const InnerSteps& inner,
                          double time,
                          std::size_t a) {
    const float pa = p_[a];
    Eight sx{}, sy{}, sF{};
    for (const PairBlock& block : evaluation.pairs(a)) {
        const std::uint32_t* b = block.index;
        const Eight difference =
            Eight{p_[b[0]], p_[b[1]], p_[b[2]], p_[b[3]], p_[b[4]], p_[b[5]], p_[b[6]], p_[b[7]]}
            - pa;
        sx += load_eight(block.x) * difference;
        sy += load_eight(block.y) * difference;
        sF -= load_eight(block.F) * difference;
    }
    const Four sums = lane_sums(sx, sy, sF);
    const Correction& L = evaluation.L[a];
    float px = L.xx * sums[0] + L.xy * sums[1], py = L.yx * sums[0] + L.yy * sums[1];
    curvature_[a] = sums[2];
    const Drive& drive = drive_[a];
    const auto elapsed = static_cast<float>(time), step = static_cast<float>(inner.step);
    const WallTerms* wall = evaluation.wall(a);
    if (wall != nullptr) {
        Vec2 b;
        if constexpr (Buoyancy) {
            const double T = particles.fields[a].T + time * evaluation.heating[a];
            b = inner.hydrostatics->departure(T, particles.compartment[a]);
        }
        const Vec2 known = inner.density * (wall->L_N_n * b - wall->L_N_acceleration);
        px += static_cast<float>(known.x);
        py += static_cast<float>(known.y);
    }
    const auto specific_volume = static_cast<float>(1 / inner.density);
    Flow& flow = flow_[a];
    flow.u += step * (drive.x + elapsed * drive.rate_x - specific_volume * px);
    flow.v += step * (drive.y + elapsed * drive.rate_y - specific_volume * py);
    if (wall != nullptr) { // of the friction that follows, what -k v does; the rest is in the drive
        flow.u /= 1 + step * static_cast<float>(wall->friction.u);
        flow.v /= 1 + step * static_cast<float>(wall->friction.v);
    }
    flow.px = px;
    flow.py = py;
}

/// dp/dt = (1 - phi) r + phi dP/dt + v.grad p,   dP/dt = r - P/tau,
/// r = -rho c^2 (div v + 2 (t - t_mid) det grad v) + delta h c psi,
/// psi = sum 2 V F [ (p_a - p_b) - (grad p_a + grad p_b).x_ab / 2 ].
/// The places stay those of the middle of the outer step, t_mid, while the velocities go on; seen
/// there those of a flow without divergence have one, since its div(dv/dt) = -2 det grad v.
/// Without relaxation (phi = 0) a uniform wind of c/10 makes waves of some seven spacings grow by
/// 3 % a step, since v.grad p is taken at the step's start, and the sound of a room rings on.
/// `relaxing` is P of the particle a.
void Pressure::compress(const Evaluation& evaluation,
                        const Compression& terms,
                        float& relaxing,
                        std::size_t a) {
    const Flow& own = flow_[a];
    const auto load = [](const Flow& flow) {
        Four r;
        std::memcpy(&r, &flow, sizeof r);
        return r;
    };
    const Four mine = load(own);
    // sum w_x, w_y times the differences of u, v, p_x, p_y; in two parts each, because one chain of
    // additions would be slower than all the rest.
    Four x0{}, x1{}, y0{}, y1{};
    for (const PairBlock& block : evaluation.pairs(a)) {
        for (std::size_t k = 0; k < eight; k += 2) {
            const Four even = load(flow_[block.index[k]]) - mine;
            const Four odd = load(flow_[block.index[k + 1]]) - mine;
            x0 += block.x[k] * even;
            x1 += block.x[k + 1] * odd;
            y0 += block.y[k] * even;
            y1 += block.y[k + 1] * odd;
        }
    }
    const Four sx = x0 + x1, sy = y0 + y1;
    float stiffness = terms.stiffness;
    float divergence = 0;
    if (const WallTerms* wall = evaluation.wall(a)) {
        const Correction& L = wall->L_velocity;
        divergence = L.xx * sx[0] + L.xy * sy[0] + L.yx * sx[1] + L.yy * sy[1]
                     + static_cast<float>(wall->value - own.u * wall->L_S.x - own.v * wall->L_S.y);
        stiffness *= wall->softness;
    } else {
        const Correction& L = evaluation.L[a];
        divergence = L.xx * sx[0] + L.xy * sy[0] + L.yx * sx[1] + L.yy * sy[1];
    }
    divergence -= terms.ahead * turning_[a];
    const WeightSum& w = evaluation.weight_sum[a];
    const float psi = 2 * curvature_[a] - (sx[2] + sy[3]) - 2 * (w.x * own.px + w.y * own.py);
    const float answer = terms.step * (terms.diffusion * psi - stiffness * divergence);
    const float before = relaxing;
    relaxing = terms.kept * (before + answer);
    next_p_[a] = p_[a] + (1 - share) * answer + share * (relaxing - before)
                 + terms.step * (own.u * own.px + own.v * own.py);
}

template <bool Buoyancy>
Booked Pressure::run(Particles& particles, Evaluation& evaluation, const InnerSteps& inner) {
    const std::size_t n = particles.size();
    flow_.resize(n);
    drive_.resize(n);
    p_.resize(n);
    next_p_.resize(n);
    turning_.resize(n);
    curvature_.resize(n);
    const auto narrow = [](double value) { return static_cast<float>(value); };
    const float twice = 2 * narrow(inner.smoothness);
    for_particles(n, threads_, [&](std::size_t a) {
        const Fields& f = particles.fields[a];
        flow_[a] = {narrow(f.u), narrow(f.v), 0, 0};
        p_[a] = narrow(f.p);
        const Slope &x = evaluation.slope_x[a], &y = evaluation.slope_y[a];
        turning_[a] = twice * (y.u * x.v - x.u * y.v);
        Vec2 force = evaluation.viscous[a], rate;
        if constexpr (Buoyancy) {
            const std::uint16_t compartment = particles.compartment[a];
            force += inner.hydrostatics->departure(f.T, compartment);
            rate = evaluation.heating[a] * inner.hydrostatics->per_kelvin();
        }
        if (const WallTerms* wall = evaluation.wall(a)) {
            // k (v_start + a t - v), a of late, t and v at each inner step's end: what goes on as
            // before is not slowed. (The rate counts from the inner step's middle.)
            const Friction& k = wall->friction;
            const Slope& now = particles.rate[a];
            const Vec2 faster{k.u * static_cast<double>(now.u), k.v * static_cast<double>(now.v)};
            force += Vec2{k.u * f.u, k.v * f.v} + (0.5 * inner.step) * faster;
            rate += faster;
        }
        drive_[a] = {narrow(force.x), narrow(force.y), narrow(rate.x), narrow(rate.y)};
    });
    const double c = inner.sound_speed, h = inner.smoothing_length;
    Compression terms{narrow(inner.density * c * c),
                      narrow(diffusion * h * c),
                      narrow(inner.step),
                      narrow(1 / (1 + inner.step * c / (relaxation * h)))};
    const double dt = inner.count * inner.step;
    for (int s = 0; s < inner.count; ++s) {
        const double time = (s + 0.5) * inner.step; // of its middle
        for_particles(n, threads_, [&](std::size_t a) {
            accelerate<Buoyancy>(particles, evaluation, inner, time, a);
        });
        terms.ahead = narrow(time + 0.5 * inner.step - 0.5 * dt);
        for_particles(n, threads_, [&](std::size_t a) {
            compress(evaluation, terms, particles.relaxing[a], a);
        });
        p_.swap(next_p_);
    }
    const auto finish = [&](std::size_t a) {
        Fields& f = particles.fields[a];
        const auto gain = [&](float now, double before) {
            return static_cast<double>(now) - static_cast<double>(narrow(before));
        };
        const double u = gain(flow_[a].u, f.u), v = gain(flow_[a].v, f.v);
        const Vec2 mean{f.u + 0.5 * u, f.v + 0.5 * v};
        f.u += u;
        f.v += v;
        f.p += gain(p_[a], f.p);
        Slope& rate = particles.rate[a];
        rate.u = recent(rate.u, u / dt);
        rate.v = recent(rate.v, v / dt);
        evaluation.slope_x[a].p = flow_[a].px;
        evaluation.slope_y[a].p = flow_[a].py;
        Vec2 force = inner.given_force.empty() ? Vec2{} : inner.given_force[a];
        const Vec2 viscous = evaluation.viscous[a] - force;
        if constexpr (Buoyancy) {
            force += inner.hydrostatics->force(f.T + 0.5 * dt * evaluation.heating[a]);
        }
        return Booked{dt * force, dt * dot(force, mean), dt * dot(viscous, mean)};
    };
    booked_.resize(chunks_of(n));
    for_chunks(n, threads_, [&](std::size_t chunk, std::size_t first, std::size_t last) {
        Booked part;
        for (std::size_t a = first; a < last; ++a) {
            part += finish(a);
        }
        booked_[chunk] = part;
    });
    Booked all;
    for (const Booked& part : booked_) {
        all += part;
    }
    return all;
}

template Booked Pressure::run<false>(Particles&, Evaluation&, const InnerSteps&);
template Booked Pressure::run<true>(Particles&, Evaluation&, const InnerSteps&);

} // namespace duet::fluid
