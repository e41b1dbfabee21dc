// Bodies whose shape is a mesh file, as far as the checks of a case need it.

#pragma once

#include "duet/v1/scene.pb.h"
#include "solid_solver/mesh.hpp"

#include <optional>
#include <string>

namespace duet::orchestrator {

/// The mesh of a body whose shape is a .msh file; none for another shape, for a .geo file, which is
/// meshed when the solid starts, and for a file or mesh at fault, with a sentence in `fault`.
std::optional<solid::Mesh> mesh_of(const v1::Body& body, std::string* fault = nullptr);

/// Names of the mesh's curves that lie, in part at least, on its boundary.
std::vector<std::string> boundary_curves(const solid::Mesh& mesh);

} // namespace duet::orchestrator
