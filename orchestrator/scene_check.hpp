// The checks of a scene as a whole, beyond its single keys: geometry, names, and references. No
// physics: what a solver cannot model, the solver refuses itself.

#pragma once

#include "orchestrator/case_file.hpp"

namespace duet::orchestrator {

/// Throws CaseError with every problem found.
void check_scene(const Case& given);

/// Where `time.end` was given on the command line, leaves out what the case holds against
/// references later than that; without it such a time is a fault that check_scene tells.
void leave_out_later_checks(Case& given);

} // namespace duet::orchestrator
