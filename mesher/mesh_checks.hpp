#pragma once

/// Checks that elements form a mesh: they have volumes and share whole sides, without hidden gaps.

#include <cstddef>
#include <vector>

#include "common/errors.hpp"
#include "mesh/mesh.hpp"

namespace suffuse {

/// Numbers by which messages name nodes and elements.
struct MeshTags {
  std::vector<std::size_t> nodes;
  std::vector<std::size_t> elements;
};

/// Reorients elements that are not positively oriented, and returns their number. Adds to
/// `problems`, `found` and `expected` only: nodes at one place, elements without a volume, elements
/// that overlap, nodes on sides of other elements, and parts that lie on each other.
template <int Dim>
int check_mesh(Mesh<Dim>& mesh, const MeshTags& tags, std::vector<InputProblem>& problems);

}  // namespace suffuse
