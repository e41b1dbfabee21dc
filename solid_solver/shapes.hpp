// Meshes of simple shapes.

#pragma once

#include "solid_solver/mesh.hpp"

namespace duet::solid {

/// Rectangle [corner, corner + (width, height)] cut into squares of about `element_size` (the
/// nearest number of whole cells along each side), each into two triangles. The diagonals point to
/// the rectangle's centre, so that they alternate from quarter to quarter: with even numbers of
/// cells the mesh is its own mirror image in both middle lines, no corner is a triangle of its own,
/// and within a quarter all diagonals are alike, on which edge domains are at their best (in
/// bending they come several times closer than on diagonals that alternate from cell to cell).
/// Nodes are numbered row by row from the lower left; the curves are left, right, bottom and top.
/// Throws std::invalid_argument if a length is not positive, or the cells are more than 1e8.
Mesh rectangle_mesh(const Point& corner, double width, double height, double element_size);

/// Disc: rings of nodes about the centre, six more in each, about `element_size` apart. The curve
/// is rim. Throws std::invalid_argument as rectangle_mesh.
Mesh disc_mesh(const Point& centre, double radius, double element_size);

/// Ring between two radii: circles of as many nodes each that the middle circle's lie about
/// `element_size` apart, every second one turned by half a pitch, so that the triangles lean to
/// neither side. The curves are inner and outer. Throws std::invalid_argument as rectangle_mesh, if
/// the inner radius is not smaller than the outer, or if the thickness is less than the height of
/// the arc over an element.
Mesh ring_mesh(const Point& centre, double inner_radius, double outer_radius, double element_size);

} // namespace duet::solid
