#pragma once

/// Keys of the table [check].

#include <vector>

#include "scene/scene_schema.hpp"

namespace suffuse {

/// In the order of the scene reference.
std::vector<SceneKey> check_keys();

}  // namespace suffuse
