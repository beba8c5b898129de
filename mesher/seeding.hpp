#pragma once

/// Places material points in the elements of a mesh.

#include <array>
#include <vector>

#include "case/material_points.hpp"
#include "case/scene.hpp"

namespace suffuse {

/// One point of a quadrature rule: barycentric coordinates and the share of the element's volume.
template <int Dim>
struct QuadraturePoint {
  std::array<double, Dim + 1> barycentric;
  double weight;
};

/// The symmetric rule of positive weights and interior points that has `count` points on the
/// triangle: 1 (exact to degree 1), 3 (2), 6 (4) or 12 (6).
/// D. A. Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129-1148. Throws InputError for other
/// counts.
std::vector<QuadraturePoint<2>> triangle_rule(int count);

/// Solid points: `points.solid_per_element` per element, each with its weight's share of the
/// volume. With `points.jitter` each point moves in a random direction by a random distance of up
/// to jitter times the element's size sqrt(2 area), but stays within its element; volumes do not
/// change. The same seed gives the same points on every platform.
MaterialPoints<2> seed_solid_points(const Mesh<2>& mesh, const PointSettings& settings);

}  // namespace suffuse
