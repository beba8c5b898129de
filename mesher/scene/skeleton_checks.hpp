#pragma once

/// Checks the keys of skeletons that move, and of the conditions that fix or load them, against
/// each other.

#include "scene/scene_checks.hpp"

namespace suffuse {

void check_skeletons(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse
