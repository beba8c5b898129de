#pragma once

/// Simplicial mesh with named regions and boundaries: triangles for Dim = 2, tetrahedra for 3.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace suffuse {

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;

/// A named set of outer faces, each given by its nodes. For a wall or a well inside the mesh
/// (`slit.hpp`) it holds both sides, one after the other: faces[2 i] and faces[2 i + 1] lie at the
/// same place.
template <int Dim>
struct BoundarySet {
  std::string name;
  std::vector<std::array<int, Dim>> faces;
};

template <int Dim>
struct Mesh {
  std::vector<Vector<Dim>> nodes;                  ///< m
  std::vector<std::array<int, Dim + 1>> elements;  ///< positively oriented
  std::vector<int> element_region;                 ///< index into `region_names`, per element
  std::vector<std::string> region_names;
  std::vector<BoundarySet<Dim>> boundaries;

  [[nodiscard]] int element_count() const { return static_cast<int>(elements.size()); }
  [[nodiscard]] int node_count() const { return static_cast<int>(nodes.size()); }
};

/// Signed area (2D, m2, which is m3 per metre of thickness) or volume (3D, m3) of an element.
template <int Dim>
double element_volume(const Mesh<Dim>& mesh, int element);
/// Mean size of the elements: that of a square or cube of their mean volume, m.
template <int Dim>
double mean_size(const Mesh<Dim>& mesh);

/// Edge of the regular triangle or tetrahedron of an area, m2, or a volume, m3.
template <int Dim>
double regular_edge(double volume) {
  return Dim == 2 ? 1.52 * std::sqrt(volume) : 2.04 * std::cbrt(volume);
}

template <int Dim>
Vector<Dim> element_centroid(const Mesh<Dim>& mesh, int element);

/// Barycentric coordinates of a place in an element; outside of it some are negative.
template <int Dim>
std::array<double, Dim + 1> barycentric(const Mesh<Dim>& mesh, int element, const Vector<Dim>& x);

/// Lengths of the box around the mesh, m.
template <int Dim>
Vector<Dim> extent(const Mesh<Dim>& mesh);

/// Largest magnitude of a coordinate of a node, m.
template <int Dim>
double largest_coordinate(const Mesh<Dim>& mesh);

/// Smallest interior angle of all elements, between edges of a triangle or faces of a tetrahedron,
/// degrees.
template <int Dim>
double smallest_angle(const Mesh<Dim>& mesh);
template <>
double smallest_angle(const Mesh<2>& mesh);
template <>
double smallest_angle(const Mesh<3>& mesh);

}  // namespace suffuse
