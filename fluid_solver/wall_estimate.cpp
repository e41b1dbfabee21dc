#include "fluid_solver/wall_estimate.hpp"

#include <algorithm>

namespace duet::fluid {

namespace {

constexpr double rounding = 1e-9; ///< of sums of lengths

} // namespace

template <class Of>
Of WallEstimate::stretch(const Boundary& boundary,
                         const std::vector<Of>& sums,
                         std::uint32_t cell,
                         double half_width) {
    const auto& cells = boundary.cells();
    Of total = sums[cell];
    const auto walk = [&](std::uint32_t WallCell::*next, double direction) {
        double start = 0.5 * cells[cell].length;
        for (std::uint32_t c = cells[cell].*next; c != none && c != cell && start < half_width;
             c = cells[c].*next) {
            const double length = cells[c].length;
            const double ahead = direction * (start + 0.5 * length);
            const double left = half_width - start;
            total.add(left < length ? left / length : 1, ahead, sums[c]);
            start += length;
        }
    };
    walk(&WallCell::before, 1);
    walk(&WallCell::after, -1);
    return total;
}

/// dw_n/ds, w the wall's velocity: over a spacing to either side as far as the wall is smooth,
/// since nodes closer together shake faster than the exchange can follow.
double WallEstimate::turn_of_wall(const Boundary& boundary, std::uint32_t cell) const {
    const auto& cells = boundary.cells();
    struct End {
        Vec2 position, velocity;
    };
    const auto end = [&](std::uint32_t WallCell::*next) {
        std::uint32_t c = cell;
        for (double way = 0;
             way < spacing_ * (1 - rounding) && cells[c].*next != none && cells[c].*next != cell;) {
            way += cells[c].length;
            c = cells[c].*next;
        }
        const Segment& segment = boundary.segments()[cells[c].segment];
        const double w = cells[c].centre;
        return End{(1 - w) * segment.a + w * segment.b,
                   (1 - w) * boundary.velocity(segment.node_a)
                       + w * boundary.velocity(segment.node_b)};
    };
    const End before = end(&WallCell::before), after = end(&WallCell::after);
    const double distance = norm(after.position - before.position);
    return distance > 0 ? dot(after.velocity - before.velocity, cells[cell].normal) / distance : 0;
}

namespace {

/// Of the temperature at the middle of a cell whose heat flux is known.
double known_slope(const Boundary& boundary, const WallCell& cell) {
    const Segment& s = boundary.segments()[cell.segment];
    return (1 - cell.centre) * boundary.temperature(s.node_a)
           + cell.centre * boundary.temperature(s.node_b);
}

} // namespace

/// The velocity across a wall starts with the square of the distance, and continuity says how: from
/// u_n,n + u_t,s = 0 follows u_n,nn = -d(u_t,n)/ds, here from u_t,n two spacings to either side.
/// Nearer than that to a corner, a wall that slips or a cell without an estimate it counts as zero:
/// most corners hold no flow, and where one slides into another (a lid) u_t,n has no bound.
double WallEstimate::bend(const Boundary& boundary, std::uint32_t cell) const {
    const auto& cells = boundary.cells();
    const double reach = 2 * spacing_ * (1 - rounding); // four cells of half a spacing are enough
    struct End {
        std::uint32_t cell;
        double way;
    };
    const auto end = [&](std::uint32_t WallCell::*next) {
        End e{cell, 0};
        while (e.way < reach) {
            const std::uint32_t c = cells[e.cell].*next;
            if (c == none || c == cell || !slopes_[c]) {
                break;
            }
            e.way += 0.5 * (cells[e.cell].length + cells[c].length);
            e.cell = c;
        }
        return e;
    };
    const End before = end(&WallCell::before), after = end(&WallCell::after);
    if (before.way < reach || after.way < reach) {
        return 0;
    }
    return (*slopes_[before.cell] - *slopes_[after.cell]) / (before.way + after.way);
}

template <class Of>
Of WallEstimate::sums_about(const Boundary& boundary,
                            const std::vector<Of>& sums,
                            std::uint32_t cell) const {
    Of total = stretch(boundary, sums, cell, spacing_);
    for (int widen = 2; widen <= 4 && total.empty(); ++widen) {
        total = stretch(boundary, sums, cell, widen * spacing_);
    }
    return total;
}

/// With w = 1 - d/(1.5 dx), curvature K = div n and lap f = f_nn + K f_n, the slope along n is
///     sum w d (f_w - f_a + bend_a d^2) / sum w d^2 (1 + K d/2).
/// At the wall pressure and forces bend the velocity, as they do next to it: bend = lap u / 2. The
/// temperature has no such source there, and a flow that carries heat only with d^2: so it departs
/// from its slope with d^4, and bend = lap T / 12. (A half would be exact where the wall's
/// temperature changes, and six times too much in a layer that does not.) Along the wall
/// (grad u + grad u^T).n is du_t/dn + dw_n/ds, w the wall's own velocity; across it it is
/// -2 dw_t/ds, nothing on a wall that does not stretch. Where the samples are, the velocity's slope
/// is less by lap u d. From the same d^4 follows, beside a wall of one temperature (else lap T does
/// not vanish there), what the Laplacians make of it,
///     q = sum w d^2 lap T / sum w d^2 (12 d^2 + quartic error),
/// and what of that is error is taken out of the heat flux here and of dT/dt by
/// Evaluation::correct_samples().
void WallEstimate::slopes(const Boundary& boundary,
                          const Evaluation& evaluation,
                          const Particles& particles,
                          const WallMaterial& material) {
    const auto per = [](double factor, double diffusivity) {
        return diffusivity > 0 ? factor / diffusivity : 0;
    };
    const double per_nu = per(1, material.kinematic_viscosity);
    const double per_alpha = per(material.density * material.heat_capacity, material.conductivity);
    sums_.assign(boundary.cells().size(), {});
    for (const auto& chunk : evaluation.samples) {
        for (const WallSample& sample : chunk) {
            const double d = sample.distance, w = evaluation.sample_weight(d);
            const std::size_t a = sample.particle;
            const Vec2 lap_v = per_nu * evaluation.viscous[a];
            const double lap_T = per_alpha * evaluation.heating[a];
            const Lanes bend{0.5 * lap_v.x, 0.5 * lap_v.y, 0, lap_T / 12};
            Sums& s = sums_[sample.cell];
            s.w += w * Lanes{1, d * d, d * d * d, d * d * (12 * d * d + sample.quartic_error)};
            s.rise += (w * d) * (sample.wall - sample.fields + (d * d) * bend);
            s.lap += (w * d * d) * Lanes{d * lap_v.x, d * lap_v.y, d * sample.quartic_error, lap_T};
            s.compartment = particles.compartment[a];
        }
    }
    const bool walls_move = boundary.speed() > 0;
    loads_.assign(sums_.size(), {});
    slopes_.assign(sums_.size(), {});
    quartics_.assign(sums_.size(), 0);
    bends_.resize(sums_.size());
    for (std::uint32_t c = 0; c < sums_.size(); ++c) {
        const Sums s = sums_about(boundary, sums_, c);
        if (s.empty()) {
            continue; // a bay too narrow to hold a particle passes nothing
        }
        const WallCell& cell = boundary.cells()[c];
        const double per_bent = 1 / (s.w[1] + 0.5 * cell.curvature * s.w[2]);
        const Vec2 tangent{cell.normal.y, -cell.normal.x}; // in the direction of travel
        // What turns with the wall is not sheared: the bend is that of the rest.
        const double turning = walls_move ? s.w[1] * turn_of_wall(boundary, c) : 0;
        const double rise = dot({s.rise[0], s.rise[1]}, tangent);
        const double shear = cell.slip ? 0 : (rise + turning) * per_bent;
        if (!cell.slip) {
            slopes_[c] = (rise - dot({s.lap[0], s.lap[1]}, tangent)) * per_bent;
        }
        quartics_[c] = cell.one_temperature && s.w[3] > 0 ? s.lap[3] / s.w[3] : 0;
        loads_[c].compartment = s.compartment;
        const double slope_T = cell.heated ? (s.rise[3] - quartics_[c] / 12 * s.lap[2]) * per_bent
                                           : known_slope(boundary, cell);
        loads_[c].heat_flux = material.conductivity * slope_T;
        loads_[c].shear = -(material.density * material.kinematic_viscosity * shear) * tangent;
    }
    for (std::uint32_t c = 0; c < sums_.size(); ++c) {
        bends_[c] = sums_[c].empty() || !slopes_[c] ? 0 : bend(boundary, c);
    }
}

/// The pressure is extrapolated with its known slope rho (b - a_wall).n across the wall and its
/// gradient along the wall.
void WallEstimate::tractions(const Boundary& boundary,
                             const Evaluation& evaluation,
                             const Particles& particles,
                             const Hydrostatics& hydrostatics,
                             const WallMaterial& material,
                             std::span<const Vec2> body_force) {
    pressure_sums_.assign(loads_.size(), {});
    for (const auto& chunk : evaluation.samples) {
        for (const WallSample& sample : chunk) {
            const Fields& f = particles.fields[sample.particle];
            const double d = sample.distance, w = evaluation.sample_weight(d);
            const Vec2 n = boundary.cells()[sample.cell].normal;
            const std::size_t a = sample.particle;
            const std::uint16_t compartment = particles.compartment[a];
            const double p = f.p + hydrostatics.pressure(particles.position(a), compartment);
            const Vec2 extra = body_force.empty() ? Vec2{} : body_force[a];
            const double across = dot(hydrostatics.force(f.T) + extra, n) - sample.acceleration;
            const Vec2 gradient = Vec2{evaluation.slope_x[a].p, evaluation.slope_y[a].p}
                                  + hydrostatics.gradient(compartment);
            const double along = dot(gradient, {n.y, -n.x}); // in the direction of travel
            PressureSums& s = pressure_sums_[sample.cell];
            s.w += w;
            s.wp += w * (p + material.density * across * d - along * sample.along);
            s.wp_along += w * along;
        }
    }
    for (std::uint32_t c = 0; c < loads_.size(); ++c) {
        const PressureSums s = sums_about(boundary, pressure_sums_, c);
        if (!s.empty()) {
            loads_[c].traction = (s.wp / s.w) * boundary.cells()[c].normal + loads_[c].shear;
        }
    }
}

} // namespace duet::fluid
