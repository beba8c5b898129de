#pragma once

/// The part of a mesh that one rank holds.

#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// The elements of a rank are a range of those of the whole mesh, which follow a curve through
/// space. The rank also holds all elements that share a node with them. Elements and nodes have the
/// order of the whole mesh, so that sums over the elements of a node have its order too.
template <int Dim>
struct LocalPart {
  Mesh<Dim> mesh;             ///< its boundaries have those faces whose element is here
  std::vector<long> element;  ///< number of each element in the whole mesh
  std::vector<long> node;     ///< number of each node in the whole mesh
  // Range of own elements, and of nodes that no element of a lower rank uses.
  int first_element = 0;
  int last_element = 0;
  int first_node = 0;
  int last_node = 0;
};

/// Throws InputError if nodes are not numbered in the order in which elements use them, as
/// suffuse-mesher does, or if a rank would have no element.
template <int Dim>
LocalPart<Dim> local_part(const Mesh<Dim>& whole, int rank, int count);

}  // namespace suffuse
