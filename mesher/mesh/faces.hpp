#pragma once

/// Faces of a simplicial mesh by their nodes: edges for Dim = 2, triangles for 3.

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// The nodes of a face in ascending order: equal for the two elements that share it.
template <int Dim>
std::array<int, Dim> face_key(std::array<int, Dim> nodes);

/// The face opposite to corner `corner` of an element.
template <int Dim>
std::array<int, Dim> face_opposite(const std::array<int, Dim + 1>& element, int corner);

/// A vector normal to a face, of any length, to either side.
template <int Dim>
Vector<Dim> face_normal(const Mesh<Dim>& mesh, const std::array<int, Dim>& face);

/// Keys of the faces of every element, sorted: a key occurs once when its face is outer, twice when
/// it lies between two elements.
template <int Dim>
class FaceTable {
 public:
  explicit FaceTable(const Mesh<Dim>& mesh);
  /// Number of elements that have this face, its nodes in any order.
  [[nodiscard]] int owners(const std::array<int, Dim>& face) const;

 private:
  std::vector<std::array<int, Dim>> keys_;
};

}  // namespace suffuse
