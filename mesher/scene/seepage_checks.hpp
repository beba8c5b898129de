#pragma once

/// Checks the keys of seepage against each other: water levels, retention, anisotropy, walls.

#include "scene/scene_checks.hpp"

namespace suffuse {

/// Checks these keys for `check_scene`.
void check_seepage(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse
