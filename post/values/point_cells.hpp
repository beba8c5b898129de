#pragma once

/// The part of a plane model that each material point fills, for pictures without gaps.

#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// A convex polygon, m, and the point whose place it is.
struct PointCell {
  std::size_t point;
  std::vector<Vector<2>> corners;
};

/// An element that is full of points is divided among them: each gets what is nearest to it. One
/// without points in the midst of soil is divided among those around. One that its points do not
/// fill is cut at the surface, where half of the surroundings is full; points outside are discs of
/// their volume. `volumes`: of the points, m3 per metre of thickness; if it is empty, points fill
/// their elements. Later cells cover earlier ones.
std::vector<PointCell> point_cells(const Mesh<2>& mesh, const std::vector<Vector<2>>& positions,
                                   const std::vector<double>& volumes);

}  // namespace suffuse
