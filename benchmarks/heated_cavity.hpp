// The heated cavity that benchmarks, the count of instructions and tests share.

#pragma once

#include "fluid_solver/scene.hpp"

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

} // namespace duet::fluid
