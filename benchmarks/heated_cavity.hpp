// The heated cavity that benchmarks, the count of instructions and tests share.

#pragma once

#include "fluid_solver/scene.hpp"

#include <cmath>
#include <numbers>

namespace duet::fluid {

/// A closed unit square, Pr = 0.71, lengths in L, time in L^2/alpha: the left wall at 1, the right
/// one at 0, all at 0.5 and at rest.
inline Config heated_cavity(double Ra, double spacing) {
    const double Pr = 0.71;
    Config config;
    config.spacing = spacing;
    config.region = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    config.kinematic_viscosity = Pr;
    config.conductivity = 1;
    config.thermal_expansion = 1;
    config.gravity = {0, -Ra * Pr};
    config.initial_temperature = config.reference_temperature = 0.5;
    config.walls = {{"hot", {0, 0}, {0, 1}, 1.0, {}}, {"cold", {1, 0}, {1, 1}, 0.0, {}}};
    return config;
}

/// A roll that fills it, at 100 alpha/L, in the temperature of conduction.
inline Values roll(Vec2 x) {
    const double pi = std::numbers::pi, sx = std::sin(pi * x.x), sy = std::sin(pi * x.y);
    Values values;
    values.temperature = 1 - x.x;
    values.velocity =
        100 * Vec2{sx * sx * std::sin(2 * pi * x.y), -sy * sy * std::sin(2 * pi * x.x)};
    return values;
}

} // namespace duet::fluid
