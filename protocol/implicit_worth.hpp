// What the solid's choice of its steps and the forecast of `duet check` agree on.

#pragma once

#include "duet/v1/scene.pb.h"

namespace duet::protocol {

/// Heated by its own compression (31).
inline bool heats_itself(const v1::Body& body) {
    return body.motion() == v1::Body::DEFORMABLE && body.thermoelastic_heating()
           && body.thermal_expansion() != 0;
}

/// What an implicit step of a body costs, in explicit steps of it; measured, docs/performance.md.
inline double implicit_worth(const v1::Body& body) {
    return body.motion() != v1::Body::DEFORMABLE ? 80 : heats_itself(body) ? 120 : 30;
}

} // namespace duet::protocol
