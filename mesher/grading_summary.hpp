#pragma once

/// What suffuse-mesher prints about the gradations of a scene.

#include <string>

#include "scene/scene.hpp"

namespace suffuse {

/// For each soil with a gradation: its fines, its skeleton fraction and the source of that, and a
/// line for each check. Empty when there is no such soil.
std::string grading_summary(const SceneDocument& document);

/// `grading_summary` for `--check`; a sentence says so when no soil has a gradation.
std::string grading_report(const SceneDocument& document);

}  // namespace suffuse
