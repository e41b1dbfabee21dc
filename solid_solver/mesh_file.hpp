// Meshes from files: .msh as they are, .geo meshed by the program gmsh.

#pragma once

#include "solid_solver/mesh.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::solid {

/// Reads the mesh of `path`, of the physical surfaces `parts` or all. A .geo file is meshed first,
/// in elements no longer than `element_size` m if that is positive; the mesh stays in `folder`
/// beside what gmsh said. Throws std::invalid_argument with a sentence: see read_msh; no gmsh, or
/// one that fails, with its own words, or does not end within ten minutes.
Mesh read_mesh_file(const std::filesystem::path& path,
                    const std::vector<std::string>& parts,
                    double element_size,
                    const std::filesystem::path& folder);

} // namespace duet::solid
