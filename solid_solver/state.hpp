// The whole state of the solids as bytes, and back.

#pragma once

#include "solid_solver/solid.hpp"

#include <string>

namespace duet::solid {

/// Everything that the next step depends on, and the accounts. For the same program on the same
/// kind of machine: numbers are kept as they are in memory.
std::string save_state(Solid& solid);

/// Takes up a state of the same scene: going on gives the same bits as never having stopped.
/// Throws std::invalid_argument with a sentence if the state is of another scene or damaged.
void restore_state(Solid& solid, const std::string& state);

} // namespace duet::solid
