#pragma once

/// Checks the keys of [check] against each other and against the rest of the scene.

#include "scene/scene_checks.hpp"

namespace suffuse {

/// Checks these keys for `check_scene`.
void check_assessment(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse
