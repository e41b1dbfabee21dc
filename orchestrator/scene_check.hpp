// The checks of a scene as a whole, beyond its single keys: geometry, names, and references. No
// physics: what a solver cannot model, the solver refuses itself.

#pragma once

#include "orchestrator/case_file.hpp"

namespace duet::orchestrator {

/// Throws CaseError with every problem found.
void check_scene(const Case& given);

} // namespace duet::orchestrator
