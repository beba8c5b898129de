#pragma once

/// The place of a point in a mesh, and its passage from one element into the next.

#include <algorithm>
#include <sstream>

#include "common/errors.hpp"
#include "grid/grid.hpp"
#include "mesh/mesh.hpp"
#include "mesh/place_text.hpp"

namespace suffuse {

/// Barycentric coordinates in the element that holds the point.
template <int Dim>
struct PointPlace {
  int element;
  std::array<double, Dim + 1> barycentric;

  [[nodiscard]] Vector<Dim> position(const Mesh<Dim>& mesh) const {
    Vector<Dim> x = Vector<Dim>::Zero();
    for (int a = 0; a <= Dim; ++a) x += barycentric[a] * mesh.nodes[mesh.elements[element][a]];
    return x;
  }
};

/// Value at a place of a field that is linear between nodes.
template <int Dim, class Value>
Value interpolate(const Grid<Dim>& grid, const PointPlace<Dim>& place,
                  const std::vector<Value>& at_nodes) {
  const auto& nodes = grid.mesh.elements[place.element];
  Value value = place.barycentric[0] * at_nodes[nodes[0]];
  for (int a = 1; a <= Dim; ++a) value += place.barycentric[a] * at_nodes[nodes[a]];
  return value;
}

/// Moves a point exactly onto the face opposite local vertex `vertex`; coordinates sum to one.
template <std::size_t Count>
void put_on_face(std::array<double, Count>& at, int vertex) {
  at[vertex] = 0.0;
  double sum = 0.0;
  for (double& share : at) {
    share = std::max(0.0, share);
    sum += share;
  }
  for (double& share : at) share /= sum;
}

/// Place of a point on the inner face opposite local vertex `vertex`, in the element on the other
/// side of the face.
template <int Dim>
PointPlace<Dim> across(const Grid<Dim>& grid, const PointPlace<Dim>& place, int vertex) {
  const int e = place.element;
  PointPlace<Dim> there{grid.across(e, vertex), {}};
  for (int a = 0; a <= Dim; ++a) {
    for (int b = 0; b <= Dim; ++b) {
      if (grid.mesh.elements[there.element][b] == grid.mesh.elements[e][a] && a != vertex) {
        there.barycentric[b] = place.barycentric[a];
      }
    }
  }
  return there;
}

/// A point that crosses this number of faces in one step moves in a circle.
inline constexpr int max_crossings = 10000;

/// Throws NumericalError for point `id`, which crosses faces without end.
template <int Dim>
[[noreturn]] void refuse_endless(const Grid<Dim>& grid, const PointPlace<Dim>& place, long id) {
  std::ostringstream message;
  message << "liquid point " << id << " at " << place_text<Dim>(place.position(grid.mesh))
          << " in element " << place.element << " crosses faces without end; take a shorter step";
  throw NumericalError(message.str());
}

}  // namespace suffuse
