#pragma once

/// What suffuse-mesher tells about its result.

#include <string>
#include <vector>

#include "case/material_points.hpp"

namespace suffuse {

/// Counts, smallest angle, areas of the regions and lengths of the boundaries, then the notes; one
/// aligned line each.
std::string mesh_summary(const Mesh<2>& mesh, const MaterialPoints<2>& points,
                         const std::vector<std::string>& notes);

/// A sentence when the smallest angle is below 5 degrees, empty otherwise.
std::string angle_warning(const Mesh<2>& mesh);

}  // namespace suffuse
