// The quantities that a probe of the fluid may name, each beside what it is.

#pragma once

#include "duet/v1/coupling.pb.h"
#include "fluid_solver/fluid.hpp"

namespace duet::fluid {

/// Throws SceneError naming the probe if its quantity is unknown, or its point does not lie in the
/// fluid.
void check_probe(const v1::Probe& probe, const v1::Scene& scene, const Fluid& fluid);

/// Takes one probe of the fluid.
v1::Sample take_probe(const v1::Probe& probe, const v1::Scene& scene, const Fluid& fluid);

} // namespace duet::fluid
