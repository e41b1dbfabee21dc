#include "fluid_solver/wall_estimate.hpp"

#include <algorithm>

namespace duet::fluid {

void WallEstimate::Sums::add(double share, double ahead, const Sums& other) {
    if (other.w > 0) {
        compartment = other.compartment;
    }
    w += share * other.w;
    wdd += share * other.wdd;
    wp += share * (other.wp + ahead * other.wp_along);
    wp_along += share * other.wp_along;
    wddd += share * other.wddd;
    rise += share * other.rise;
}

/// Sums over the cells within half_width of the middle of `cell` along the wall, up to the next
/// corner; a cell that is cut counts with the part that is inside.
WallEstimate::Sums
WallEstimate::stretch(const Boundary& boundary, std::uint32_t cell, double half_width) const {
    const auto& cells = boundary.cells();
    Sums total;
    total.add(1, 0, sums_[cell]);
    const auto walk = [&](std::uint32_t WallCell::*next, double direction) {
        double start = 0.5 * cells[cell].length;
        for (std::uint32_t c = cells[cell].*next; c != none && c != cell && start < half_width;
             c = cells[c].*next) {
            const double length = cells[c].length;
            const double ahead = direction * (start + 0.5 * length);
            total.add(std::min(1.0, (half_width - start) / length), ahead, sums_[c]);
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
        for (double way = 0; way < spacing_ && cells[c].*next != none && cells[c].*next != cell;) {
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

/// With w = 1 - d/(1.5 dx), curvature K = div n and lap f = f_nn + K f_n, the slope along n is
///     sum w d (f_w - f_a + bend_a d^2) / sum w d^2 (1 + K d/2).
/// At the wall pressure and forces bend the velocity, as they do next to it: bend = lap u / 2. The
/// temperature has no such source there, and a flow that carries heat only with d^2: so it departs
/// from its slope with d^4, and bend = lap T / 12. (A half would be exact where the wall's
/// temperature changes, and six times too much in a layer that does not.) The pressure is
/// extrapolated with its known slope rho (b - a_wall).n across the wall and its gradient along the
/// wall. Along the wall (grad u + grad u^T).n is du_t/dn + dw_n/ds, w the wall's own velocity;
/// across it it is -2 dw_t/ds, nothing on a wall that does not stretch.
void WallEstimate::run(const Boundary& boundary,
                       const Evaluation& evaluation,
                       const Particles& particles,
                       const Hydrostatics& hydrostatics,
                       const WallMaterial& material,
                       std::span<const Vec2> body_force) {
    const auto per = [](double factor, double diffusivity) {
        return diffusivity > 0 ? factor / diffusivity : 0;
    };
    const double bend_u = per(0.5, material.kinematic_viscosity);
    const double bend_T =
        per(material.density * material.heat_capacity / 12, material.conductivity);
    sums_.assign(boundary.cells().size(), {});
    for (const auto& chunk : evaluation.samples) {
        for (const WallSample& sample : chunk) {
            const Fields& f = particles.fields[sample.particle];
            const double d = sample.distance, w = 1 - d / evaluation.sample_depth();
            const Vec2 n = boundary.cells()[sample.cell].normal;
            const std::size_t a = sample.particle;
            const std::uint16_t compartment = particles.compartment[a];
            const double p = f.p + hydrostatics.pressure(particles.position(a), compartment);
            const Vec2 extra = body_force.empty() ? Vec2{} : body_force[a];
            const Vec2 viscous = evaluation.viscous[a] - extra;
            const Lanes bend{
                bend_u * viscous.x, bend_u * viscous.y, 0, bend_T * evaluation.heating[a]};
            const double across = dot(hydrostatics.force(f.T) + extra, n) - sample.acceleration;
            const Vec2 gradient = Vec2{evaluation.slope_x[a].p, evaluation.slope_y[a].p}
                                  + hydrostatics.gradient(compartment);
            const double along = dot(gradient, {n.y, -n.x}); // in the direction of travel
            Sums& s = sums_[sample.cell];
            s.w += w;
            s.wdd += w * d * d;
            s.wddd += w * d * d * d;
            s.rise += (w * d) * (sample.wall - sample.fields + (d * d) * bend);
            s.wp += w * (p + material.density * across * d - along * sample.along);
            s.wp_along += w * along;
            s.compartment = compartment;
        }
    }
    loads_.resize(sums_.size());
    for (std::uint32_t c = 0; c < sums_.size(); ++c) {
        Sums s = stretch(boundary, c, spacing_);
        for (int widen = 2; widen <= 4 && s.w == 0; ++widen) {
            s = stretch(boundary, c, widen * spacing_);
        }
        loads_[c] = {};
        if (s.w == 0) {
            continue; // a bay too narrow to hold a particle passes nothing
        }
        const WallCell& cell = boundary.cells()[c];
        const double bent = s.wdd + 0.5 * cell.curvature * s.wddd;
        const Vec2 tangent{cell.normal.y, -cell.normal.x}; // in the direction of travel
        // What turns with the wall is not sheared: the bend is that of the rest.
        const double turning = s.wdd * turn_of_wall(boundary, c);
        const double shear =
            cell.slip ? 0 : (dot({s.rise[0], s.rise[1]}, tangent) + turning) / bent;
        loads_[c].compartment = s.compartment;
        const double slope_T = cell.heated ? s.rise[3] / bent : known_slope(boundary, cell);
        loads_[c].heat_flux = material.conductivity * slope_T;
        loads_[c].shear = -(material.density * material.kinematic_viscosity * shear) * tangent;
        loads_[c].traction = (s.wp / s.w) * cell.normal + loads_[c].shear;
    }
}

} // namespace duet::fluid
