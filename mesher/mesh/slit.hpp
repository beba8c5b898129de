#pragma once

/// Cuts a mesh open along faces inside it, so that a wall without thickness or a well becomes a
/// pair of outer faces: later stages know walls and wells as named boundaries only.

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// A face that could not be opened: all its nodes are tips of the cuts, which stay single.
template <int Dim>
struct JoinedFace {
  std::string name;  ///< name of its set
  std::array<int, Dim> nodes;
};

/// Cuts `mesh` along the faces of `cuts`, which lie between two elements each and belong to one set
/// alone. A node is doubled for each further fan of elements around it that no uncut face joins to
/// the first: a tip inside the mesh stays single; an end at the outer boundary, a bend and both
/// sides of a crossing are separated. Appends to the mesh's boundaries one set per cut, with the
/// same name and the two sides of each face one after the other: faces[2 i] and faces[2 i + 1].
template <int Dim>
std::vector<JoinedFace<Dim>> slit(Mesh<Dim>& mesh, const std::vector<BoundarySet<Dim>>& cuts);

/// Whether `slit` made the faces of a set: they come in pairs with nodes at the same places.
template <int Dim>
bool is_slit(const Mesh<Dim>& mesh, const BoundarySet<Dim>& set);

}  // namespace suffuse
