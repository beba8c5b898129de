#pragma once

/// The part of a mesh, and of a case, that one rank holds.

#include <memory>
#include <optional>
#include <vector>

#include "case/case_file.hpp"
#include "mesh/mesh.hpp"
#include "ranks/ranks.hpp"

namespace suffuse {

/// Which elements and nodes of the whole mesh a rank holds, ascending. Its own elements are a range
/// of those of the whole mesh, which follow a curve through space; it also holds all elements that
/// share a node with them. As they keep the order of the whole mesh, so do sums over the elements
/// of a node.
struct PartNumbers {
  std::vector<long> element;  ///< number of each element in the whole mesh
  std::vector<long> node;     ///< number of each node in the whole mesh
  // Range of own elements, and of nodes that no element of a lower rank uses.
  int first_element = 0;
  int last_element = 0;
  int first_node = 0;
  int last_node = 0;
};

/// The part of a rank among those that share a run.
struct RankPart {
  std::shared_ptr<const Ranks> ranks;
  PartNumbers numbers;
};

template <int Dim>
struct LocalMesh {
  Mesh<Dim> mesh;  ///< its boundaries have those faces whose element is here
  PartNumbers numbers;
};

/// Throws InputError if nodes are not numbered in the order in which elements use them, as
/// suffuse-mesher does, or if a rank would have no element.
/// \param rings  of elements around own ones: those that share a node with them, and so on
template <int Dim>
LocalMesh<Dim> local_mesh(const Mesh<Dim>& whole, int rank, int count, int rings = 1);

/// The part of a case that belongs to such a part of its mesh: solid points of all its elements,
/// liquid points of own elements.
template <int Dim>
Case<Dim> local_case(const Case<Dim>& whole, LocalMesh<Dim> local);

/// The part of a case that a rank computes; both are empty if the program is alone.
template <int Dim>
struct OwnPart {
  std::shared_ptr<const RankPart> part;
  std::optional<Case<Dim>> own;
};
/// Throws as `local_mesh` does.
template <int Dim>
OwnPart<Dim> own_part(const Case<Dim>& whole, const std::shared_ptr<const Ranks>& ranks);

}  // namespace suffuse
