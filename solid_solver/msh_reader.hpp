// Reads meshes in Gmsh's text format, version 4.1.

#pragma once

#include "solid_solver/mesh.hpp"

#include <istream>
#include <string>
#include <vector>

namespace duet::solid {

/// The triangles of a mesh in the plane z = 0, those of the physical surfaces `parts` alone or, if
/// that is empty, all. Physical surfaces become parts and physical curves curves of the same names;
/// triangles of a surface without a name are of a part "". A surface of several groups belongs to
/// the one that is asked for. A surface all drawn clockwise is turned over; nodes that no triangle
/// uses are left out. `name` is the file's, for the sentences. Throws std::invalid_argument with
/// file, line and a sentence: another format or version, an element other than points, two-node
/// lines and three-node triangles, a node or surface that the file does not define, a place off the
/// plane by more than rounding, a file that ends early; check_mesh looks at the rest.
Mesh read_msh(std::istream& file, const std::string& name, const std::vector<std::string>& parts);

} // namespace duet::solid
