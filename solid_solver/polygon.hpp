// Where a point lies with respect to an area bounded by straight sides.

#pragma once

#include "solid_solver/mesh.hpp"

#include <vector>

namespace duet::solid {

struct Side {
    Point from, to;
};

enum class Where { outside, boundary, inside };

/// Position of a point with respect to the area that the closed loops of `sides` bound; the
/// boundary is as thick as `tolerance` on either side. The loops' direction does not matter.
Where locate(const Point& point, const std::vector<Side>& sides, double tolerance);

/// Signed distance of a point from the line of a side, positive to the left of its way.
double offset(const Side& side, const Point& point);

/// True if the two sides cross in a point that is inner to both.
bool cross(const Side& s, const Side& t, double tolerance);

/// The sides of a polygon given by its corners.
std::vector<Side> polygon_sides(const std::vector<Point>& corners);

} // namespace duet::solid
