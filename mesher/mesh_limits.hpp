#pragma once

/// Refuses element sizes that give too many elements.

#include <string>

#include "scene/scene.hpp"

namespace suffuse {

/// More are probably due to a misplaced decimal point.
inline constexpr double max_element_count = 5e6;

/// Throws an InputError about this key of the scene.
[[noreturn]] void refuse_key(const SceneDocument& document, const std::string& key,
                             const std::string& found, const std::string& expected);

/// \param area  m2
/// \param strip  width of what is meshed in rows of elements in addition, all rows together, m
void refuse_too_many_triangles(const SceneDocument& document, double area, double strip = 0.0);

/// \param volume  m3
/// \param layer  area of what is meshed in rows of elements in addition, all rows together, m2
void refuse_too_many_tetrahedra(const SceneDocument& document, double volume, double layer = 0.0);

}  // namespace suffuse
