// What both kinds of solver share in taking a probe: which points it needs, and how their values
// become a sample. The solver evaluates the field; it alone knows how.

#pragma once

#include "duet/v1/coupling.pb.h"

#include <span>
#include <vector>

namespace duet::protocol {

/// True if the probe takes a field (at a point or along a line), false if it takes an integral.
bool is_field_probe(const v1::Probe& probe);

/// The points where the field is needed: the point or those of the line, then their mirror images
/// if the probe has a mirror. Empty for an integral.
std::vector<v1::Vector> probe_points(const v1::Probe& probe);

/// The sample from the field's values at `probe_points`. `odd`: the quantity changes sign in the
/// mirror (a horizontal component). A value that is not finite marks a point outside the domain: it
/// is left out of a line, and a sample without any point left has no value. The mean over a line is
/// taken by the trapezoidal rule over the points that are left.
v1::Sample
field_sample(const v1::Probe& probe, double time, std::span<const double> values, bool odd);

/// The sample of an integral.
v1::Sample integral_sample(const v1::Probe& probe, double time, double value);

} // namespace duet::protocol
