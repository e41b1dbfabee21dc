// The plane geometry that the checks of a scene need: polygons, rectangles, lines. Lengths in m;
// `tolerance` is the distance below which two things touch.

#pragma once

#include "duet/v1/scene.pb.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace duet::orchestrator {

using Point = v1::Vector;
using Polygon = std::vector<Point>;
using Piece = std::pair<Point, Point>; ///< straight, from the first to the second

Point point(double x, double y);
double distance(const Point& a, const Point& b);

/// Corners of a rectangle, counter-clockwise from the lower left.
Polygon corners(const v1::Rectangle& rectangle);

/// Enclosed area, positive for either sense of travel.
double area(const Polygon& polygon);

/// Corners of a fine polygon in place of a circle.
Polygon corners(const v1::Disc& disc);

/// The cavity's boundary, and that of a hole in it.
Polygon outline(const v1::Fluid& fluid);
Polygon outline(const v1::Hole& hole);

/// Whether the cavity repeats itself along x, and along y.
std::pair<bool, bool> periodic(const v1::Fluid& fluid);

/// The sides of a periodic region that are no walls.
std::vector<Piece> seams(const v1::Fluid& fluid, double tolerance);

/// Of the room that a body takes, a ring's hole included; empty for a mesh file, which the solid
/// alone reads.
Polygon outline(const v1::Body& body);

/// A body's area, m2, and about how many nodes it has; 0 for a .geo file.
double area_of(const v1::Body& body);
double nodes_of(const v1::Body& body);

/// How many particles the fluid has, about.
double particles_of(const v1::Scene& scene);

/// The larger extent along x or y.
double extent(const Polygon& polygon);

/// What keeps a polygon from being simple, as half a sentence; nothing for a good one.
std::optional<std::string> polygon_fault(const Polygon& polygon, double tolerance);

bool on_boundary(const Polygon& polygon, const Point& p, double tolerance);

/// Inside or on the boundary.
bool inside(const Polygon& polygon, const Point& p, double tolerance);

/// Every point of the rectangle is inside the polygon or on its boundary.
bool rectangle_inside(const v1::Rectangle& rectangle, const Polygon& polygon, double tolerance);

/// The two share more than a boundary.
bool overlap(const v1::Rectangle& a, const v1::Rectangle& b, double tolerance);
/// The two polygons share more than boundaries.
bool overlap(const Polygon& a, const Polygon& b, double tolerance);
/// The two polygons have a point in common, if only of their boundaries.
bool meet(const Polygon& a, const Polygon& b, double tolerance);

/// Strictly inside the rectangle, farther than tolerance from its sides.
bool strictly_inside(const v1::Rectangle& rectangle, const Point& p, double tolerance);

/// The point lies on the straight piece from a to b.
bool on_piece(const Point& p, const Point& a, const Point& b, double tolerance);

/// The part of the piece c-d that lies on the piece a-b, along a-b; none if they are not on one
/// line, or apart.
std::optional<Piece>
common_piece(const Point& a, const Point& b, const Point& c, const Point& d, double tolerance);
/// Its length; 0 without one.
double
common_length(const Point& a, const Point& b, const Point& c, const Point& d, double tolerance);

} // namespace duet::orchestrator
