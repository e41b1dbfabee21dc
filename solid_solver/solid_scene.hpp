// The solid bodies of a scene, as the core takes them.

#pragma once

#include "duet/v1/scene.pb.h"
#include "solid_solver/body_config.hpp"

#include <filesystem>

namespace duet::solid {

/// One body of the scene as the core takes it; a .geo file is meshed in `folder`. Throws
/// std::invalid_argument with a sentence if the mesh is at fault.
BodyConfig
config_from_scene(const v1::Body& body, unsigned threads, const std::filesystem::path& folder);

} // namespace duet::solid
