#pragma once

/// Places material points in the elements of a mesh.

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/material_points.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// One point of a quadrature rule: barycentric coordinates and the share of the element's volume.
template <int Dim>
struct QuadraturePoint {
  std::array<double, Dim + 1> barycentric;
  double weight;
};

/// The symmetric rule of positive weights and interior points that has `count` points: on the
/// triangle 1 (exact to degree 1), 3 (2), 6 (4) or 12 (6), on the tetrahedron 1 (1), 4 (2) or 14
/// (5). D. A. Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129-1148; N. J. Walkington, Quadrature
/// on simplices of arbitrary dimension (2000). Throws InputError for other counts.
template <int Dim>
std::vector<QuadraturePoint<Dim>> gauss_rule(int count);
template <>
std::vector<QuadraturePoint<2>> gauss_rule<2>(int count);
template <>
std::vector<QuadraturePoint<3>> gauss_rule<3>(int count);

/// Solid points: `points.solid_per_element` per element, each with its weight's share of the
/// volume. With `points.jitter` each point moves in a random direction by a random distance of up
/// to jitter times the element's size, sqrt(2 area) or cbrt(6 volume), but stays within its
/// element; volumes do not change. The same seed gives the same points on every platform. Fills
/// every element, for meshes of soil alone.
template <int Dim>
MaterialPoints<Dim> seed_solid_points(const Mesh<Dim>& mesh, const PointSettings& settings);

/// Solid points in the elements of soil; free water gets none.
template <int Dim>
MaterialPoints<Dim> seed_solid_points(const Mesh<Dim>& mesh, const Scene& scene);

/// Number of liquid points of each element, from 1 to 1e9. With `points.equal_volume` it is
/// proportional to the liquid volume of the element, n_0 V_e, in free water V_e: a mean element of
/// the soils that erode (of all soils if none does) has `points.liquid_per_element`. Without it,
/// and always with Gauss points, every element has `points.liquid_per_element`.
template <int Dim>
std::vector<std::int64_t> liquid_point_counts(const Mesh<Dim>& mesh, const Scene& scene);

/// Liquid points of a double-point scene, in the numbers of `liquid_point_counts` and placed as
/// `points.seeding` says; `volume` is liquid volume and adds up to n_0 V_e in every element. Gauss
/// points have shares by their weights, other points equal shares and barycentric coordinates above
/// 1e-9. The same scene gives the same points on every platform.
///
/// The low-discrepancy points are the van der Corput sequence on the triangle, K. Basu and A. B.
/// Owen, SIAM J. Numer. Anal. 53 (2015) 743-761, and Halton's sequence on the tetrahedron, Numer.
/// Math. 2 (1960) 84-90; they continue from element to element.
template <int Dim>
MaterialPoints<Dim> seed_liquid_points(const Mesh<Dim>& mesh, const Scene& scene);

}  // namespace suffuse
