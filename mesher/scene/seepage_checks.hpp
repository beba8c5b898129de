#pragma once

/// Checks across the keys that are about seepage: water levels, retention, anisotropy, walls.

#include "scene/scene_checks.hpp"

namespace suffuse {

/// What `check_scene` asks of these keys.
void check_seepage(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse
