#pragma once

/// What axes say of columns of tables and of keys of scenes.

#include <string>

#include "case/scene.hpp"

namespace suffuse {

/// A key of a scene with its unit, a column of a table in words with its unit, or the name itself:
/// `time.end (s)`, `fines lost (%)`. The unit of a rate or a threshold follows the drive of its
/// soil in `scene`, and is left out without a scene.
std::string axis_text(const std::string& name, const Scene* scene = nullptr);

}  // namespace suffuse
