#pragma once

/// Parts of a mesh that water cannot pass between.

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// Two faces at the same place, such as the sides of a wall that conducts.
template <int Dim>
using FacePair = std::array<std::array<int, Dim>, 2>;

/// The part that each node belongs to: nodes of one element are of one part, and so are those of
/// the two faces of a pair in `joined`. A part has the number of one of its nodes.
template <int Dim>
std::vector<int> mesh_parts(const Mesh<Dim>& mesh, const std::vector<FacePair<Dim>>& joined);

}  // namespace suffuse
