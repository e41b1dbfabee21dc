// The shift that keeps the particles evenly spread (docs/theory-fluid.md, "Shift").

#pragma once

#include "fluid_solver/vector.hpp"

#include <algorithm>

namespace duet::fluid {

/// Distance by which a wall at distance d1 pushes a particle off: 0.2 (0.3 dx - d1)+.
inline double wall_push(double d1, double spacing) {
    return 0.2 * std::max(0.0, 0.3 * spacing - d1);
}

/// The factor of -gradC: min(3 h U dt, 2/3 dx^2). Beyond the cap the particles are thrown about;
/// with less of it, the sums over a longer step lose more momentum.
inline double shift_factor(double smoothing_length, double speed, double step, double spacing) {
    return std::min(3 * smoothing_length * speed * step, 2.0 / 3 * spacing * spacing);
}

/// dr = -factor gradC + push, at most 0.2 dx long.
inline Vec2 shift_vector(Vec2 concentration, Vec2 push, double factor, double spacing) {
    const Vec2 dr = push - factor * concentration;
    const double length = norm(dr), most = 0.2 * spacing;
    return length > most ? (most / length) * dr : dr;
}

} // namespace duet::fluid
