#pragma once

/// Labels of axes for columns of tables and for keys of scenes.

#include <string>

#include "scene/scene.hpp"

namespace suffuse {

/// A key of a scene or a column of a table with its unit, `time.end (s)`; another name as it is.
/// The unit of a rate or a threshold follows the drive of its soil in `scene`, and is left out
/// without a scene.
std::string axis_text(const std::string& name, const Scene* scene = nullptr);

}  // namespace suffuse
