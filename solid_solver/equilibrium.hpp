// Static equilibrium of a body under its loads, by Newton's method.

#pragma once

#include "solid_solver/mechanics.hpp"

#include <span>

namespace duet::solid {

/// How an equilibrium was found.
struct Equilibrium {
    int iterations = 0; ///< Newton iterations, of all load steps
    double residual =
        0; ///< |f_ext - f_int| over the free components, relative to the forces at work
};

/// Moves the body to rest in equilibrium with its constant loads, interface forces and
/// `temperature` [N]; held components stay where they are. Newton's method with the exact tangent;
/// where it does not converge the imbalance of the start is taken away in steps. Throws
/// std::runtime_error with a sentence if there is no way to |residual| <= tolerance.
Equilibrium
find_equilibrium(Mechanics& mechanics, std::span<const double> temperature, double tolerance);

/// The same by dynamic relaxation, for either description: explicit steps from rest under the loads
/// of the present time, stopped dead whenever the kinetic energy has passed a maximum (kinetic
/// damping; Cundall 1976). Every stop changes the length of the steps: with one length the modes
/// that are in phase at each stop would be caught in a cycle. Throws std::runtime_error with a
/// sentence if that takes more than a hundred thousand steps.
Equilibrium relax(Mechanics& mechanics, std::span<const double> temperature, double tolerance);

} // namespace duet::solid
