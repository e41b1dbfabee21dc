// Values at points between the nodes.

#pragma once

#include "solid_solver/mesh.hpp"

#include <array>
#include <optional>

namespace duet::solid {

/// A material point as a mean of the three nodes round it.
struct Interpolation {
    Triangle node{};
    std::array<double, 3> weight{}; ///< the linear shape functions there
};

/// The triangle of the reference mesh that holds `point`; none if it lies outside. A point on the
/// boundary, but for rounding, is inside. Looks at every triangle: meant to be done once a point.
std::optional<Interpolation> interpolation_at(const Mesh& mesh, const Point& point);

/// The node nearest to a place; of equals the first.
std::uint32_t nearest_node(const Mesh& mesh, const Point& place);

} // namespace duet::solid
