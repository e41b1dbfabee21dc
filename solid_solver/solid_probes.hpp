// The quantities that a probe of the solid may name, each beside what it is.

#pragma once

#include "duet/v1/coupling.pb.h"
#include "solid_solver/locator.hpp"
#include "solid_solver/solid.hpp"

#include <optional>
#include <vector>

namespace duet::solid {

/// All probes of the solid in a scene, their points found in the meshes once.
class Probes {
  public:
    Probes() = default;
    /// Throws std::invalid_argument naming the probe if its quantity or body is unknown, the body
    /// has no such field, or a point (all points of a line) lies outside the solid.
    Probes(const v1::Scene& scene, const Solid& solid);

    /// Takes all of them.
    void take(const Solid& solid,
              double time,
              google::protobuf::RepeatedPtrField<v1::Sample>& samples) const;

  private:
    struct Place {
        std::size_t body;
        Interpolation at;
    };
    struct Prepared {
        v1::Probe probe;
        std::vector<std::optional<Place>> points; ///< of a field
        std::vector<std::size_t> bodies;          ///< of an integral
    };
    std::vector<Prepared> prepared_;
};

} // namespace duet::solid
