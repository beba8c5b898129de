#pragma once

/// What the gradation of a soil says about the other keys of that soil.

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/scene_checks.hpp"

namespace suffuse {

/// Gives each soil without a `skeleton_fraction` that of its gradation, (1 - n_0)(1 - F*), where F*
/// can be told.
/// \param given  whether the scene has a key
void derive_skeletons(Scene& scene, const std::function<bool(const std::string& key)>& given);

/// Reports where a gradation cannot stand in for the skeleton that is not given.
/// \param table  of the soil, `soil.sand`
void check_grading_of(const Soil& soil, const std::string& table, const SceneInquiry& inquiry);

/// Sentences about soils that are told to erode although their fines cannot move, or carry load.
std::vector<std::string> grading_warnings(const SceneDocument& document);

}  // namespace suffuse
