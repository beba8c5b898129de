#pragma once

/// Pieces of a mesh between which no water can pass.

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace suffuse {

/// Two faces at the same place, such as the sides of a wall that conducts.
template <int Dim>
using FacePair = std::array<std::array<int, Dim>, 2>;

/// The piece that each node belongs to. The nodes of an element are in one piece, and so are those
/// of the two faces of a pair in `joined`. A piece has the number of one of its nodes.
template <int Dim>
std::vector<int> mesh_pieces(const Mesh<Dim>& mesh, const std::vector<FacePair<Dim>>& joined);

}  // namespace suffuse
