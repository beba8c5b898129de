#pragma once

/// Meshes whose nodes are numbered as suffuse-mesher does.

#include <map>

#include "mesh/mesh.hpp"

namespace suffuse {

/// The mesh with its nodes in the order in which elements use them. Elements come in stripes, so
/// that parts are not compact and own elements touch several ranks.
template <int Dim>
Mesh<Dim> in_order(const Mesh<Dim>& mesh) {
  Mesh<Dim> ordered = mesh;
  ordered.nodes.clear();
  std::map<int, int> number;
  for (auto& nodes : ordered.elements) {
    for (int& i : nodes) {
      const auto [at, is_new] = number.emplace(i, ordered.node_count());
      if (is_new) ordered.nodes.push_back(mesh.nodes[i]);
      i = at->second;
    }
  }
  for (BoundarySet<Dim>& set : ordered.boundaries) {
    for (auto& face : set.faces) {
      for (int& i : face) i = number.at(i);
    }
  }
  return ordered;
}

}  // namespace suffuse
