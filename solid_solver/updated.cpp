// The updated Lagrangian description (7)-(9): Jaumann's rate, integrated after Hughes and Winget
// (1980).

#include "solid_solver/elasticity.hpp"
#include "solid_solver/parallel.hpp"

#include <cmath>

namespace duet::solid {

namespace {

constexpr std::size_t slots = Domains::slots;

/// Area and gradients of a domain with its nodes at `at`. An inner edge a -> b with c to its left
/// and d to its right: A gradN_a = rot(c - d)/6 = -A gradN_b, A gradN_c = rot(b - a)/6 = -A gradN_d
/// and 6 A = (b - a) x (c - d), with rot(v) = (-v_y, v_x): the area-weighted mean over the two
/// triangles. A domain of one triangle takes `share` of its area, with its gradients.
Elasticity::Shape shape_of(const std::array<Point, slots>& at, bool inner, double share) {
    Elasticity::Shape shape{};
    if (inner) {
        const Point p = at[1] - at[0], q = at[2] - at[3];
        const double six = p.x() * q.y() - p.y() * q.x();
        shape = {six / 6,
                 {-q.y() / six, q.y() / six, -p.y() / six, p.y() / six},
                 {q.x() / six, -q.x() / six, p.x() / six, -p.x() / six}};
        return shape;
    }
    const Point p = at[1] - at[0], q = at[2] - at[0], r = at[2] - at[1];
    const double twice = p.x() * q.y() - p.y() * q.x();
    shape = {share * twice / 2,
             {-r.y() / twice, q.y() / twice, -p.y() / twice, 0},
             {r.x() / twice, -q.x() / twice, p.x() / twice, 0}};
    return shape;
}

/// r t r^T with r = ((c, s), (-s, c)).
PlaneTensor turned(const PlaneTensor& t, double c, double s) {
    return {c * c * t.xx + 2 * c * s * t.xy + s * s * t.yy,
            s * s * t.xx - 2 * c * s * t.xy + c * c * t.yy,
            c * s * (t.yy - t.xx) + (c * c - s * s) * t.xy,
            t.zz};
}

} // namespace

Elasticity::Shape Elasticity::present_shape(std::size_t k, const double* u) const {
    return middle_shape(k, u, u);
}

Elasticity::Shape
Elasticity::middle_shape(std::size_t k, const double* before, const double* after) const {
    const auto& node = domains_.node[k];
    std::array<Point, slots> at;
    for (std::size_t s = 0; s < slots; ++s) {
        for (std::uint32_t d = 0; d < 2; ++d) {
            const std::size_t c = 2 * node[s] + d;
            at[s][d] = reference_[c] + 0.5 * (before[c] + after[c]);
        }
    }
    return shape_of(at, node[3] != node[0], domains_.share);
}

/// dt L = sum_I dx_I gradN_I on the geometry of the middle of the step.
Elasticity::Gradient Elasticity::increment(std::size_t k,
                                           const Shape& middle,
                                           const double* before,
                                           const double* after) const {
    Gradient l;
    for (std::size_t s = 0; s < slots; ++s) {
        const std::size_t c = 2 * domains_.node[k][s];
        const double ux = after[c] - before[c], uy = after[c + 1] - before[c + 1];
        l.xx += ux * middle.x[s];
        l.xy += ux * middle.y[s];
        l.yx += uy * middle.x[s];
        l.yy += uy * middle.y[s];
    }
    return l;
}

/// sigma <- r (r sigma r^T + dt (lambda tr(D) I + 2 mu D) - beta dT I) r^T, r^2 = R = (I - dt
/// W/2)^-1 (I + dt W/2): a rigid rotation has no D on the middle geometry, however large, and turns
/// the stress by its own angle; what is added belongs to the middle of the step and turns by half
/// of it, which makes the rate's integral one of second order. Then -A sigma gradN_I on the present
/// geometry (20), with the stress rate (63).
void Elasticity::updated_forces(double dt,
                                const double* before,
                                std::span<const double> temperature) {
    const double per_step = dt > 0 ? damping_ / dt : 0;
    const double* after = displacement_.data();
    in_pieces(domains_.size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Gradient l = increment(k, middle_shape(k, before, after), before, after);
            const double half = 0.25 * (l.xy - l.yx); // dt W_xy/2, the tangent of half the angle
            const double c = 1 / std::sqrt(1 + half * half), s = c * half;
            const double now = mean(k, temperature.data());
            const double warming = now - domain_temperature_[k];
            const PlaneTensor rate = law(k).stress(l.xx, l.yy, 0.5 * (l.xy + l.yx), warming);
            const PlaneTensor added = turned(rate, c, s);
            domain_temperature_[k] = now;
            double* stress = &stress_[3 * k];
            const PlaneTensor old =
                turned(turned({stress[0], stress[1], stress[2], 0}, c, s), c, s);
            stress[0] = old.xx + added.xx;
            stress[1] = old.yy + added.yy;
            stress[2] = old.xy + added.xy;
            out_of_plane_[k] += added.zz + law(k).thickening(l.xx + l.yy, warming);
            const double thickness = law(k).plane_stress ? std::exp(out_of_plane_[k]) : 1;

            const Shape shape = present_shape(k, after);
            const double weight = shape.area * thickness;
            const double pxx = weight * (stress[0] + per_step * added.xx);
            const double pyy = weight * (stress[1] + per_step * added.yy);
            const double pxy = weight * (stress[2] + per_step * added.xy);
            if (per_step > 0) {
                book_damping(k,
                             {per_step * added.xx, per_step * added.yy, per_step * added.xy, 0},
                             {l.xx, l.yy, 0.5 * (l.xy + l.yx)},
                             weight);
            }
            if (!warming_.empty()) {
                book_expansion(k, l.xx + l.yy, now - reference_temperature_, weight);
            }
            double* out = &contribution_[2 * slots * k];
            for (std::size_t i = 0; i < slots; ++i) {
                out[2 * i] = -(pxx * shape.x[i] + pxy * shape.y[i]);
                out[2 * i + 1] = -(pxy * shape.x[i] + pyy * shape.y[i]);
            }
        }
    });
}

} // namespace duet::solid
