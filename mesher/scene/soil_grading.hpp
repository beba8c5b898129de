#pragma once

/// Effects of the gradation of a soil on its other keys.

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/scene_checks.hpp"

namespace suffuse {

/// Gives each soil without a `skeleton_fraction` that of its gradation, (1 - n_0)(1 - F*), if F* is
/// known.
/// \param given  whether the scene has a key
void derive_skeletons(Scene& scene, const std::function<bool(const std::string& key)>& given);

/// Reports a gradation that cannot replace a missing `skeleton_fraction`.
/// \param table  of the soil, `soil.sand`
void check_grading_of(const Soil& soil, const std::string& table, const SceneInquiry& inquiry);

/// Sentences about soils that have an erosion law although their fines cannot move, or carry load.
std::vector<std::string> grading_warnings(const SceneDocument& document);

}  // namespace suffuse
