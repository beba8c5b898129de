#pragma once

/// Checks across the keys of skeletons that move, and of what holds or loads them.

#include "scene/scene_checks.hpp"

namespace suffuse {

void check_skeletons(const Scene& scene, const SceneInquiry& inquiry);

}  // namespace suffuse
