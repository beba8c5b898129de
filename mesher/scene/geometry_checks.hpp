#pragma once

/// Checks of `[geometry]` and `[mesh]` together: keys that need a shape or a file.

#include <string>

#include "scene/scene_checks.hpp"

namespace suffuse {

void check_geometry(const Scene& scene, const SceneInquiry& inquiry);

// The kind of a geometry file, by the end of its name.

bool is_geo_file(const std::string& path);
bool is_mesh_file(const std::string& path);
bool is_step_file(const std::string& path);

}  // namespace suffuse
