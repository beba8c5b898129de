#pragma once

/// Which elements share their dilatation (`SharedDilatation`).

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// Patch of each element, -1 for one by itself. Triangles are joined in pairs, across their longest
/// sides first; tetrahedra in fours, each next one where it has most nodes in common with those of
/// its patch. What is left joins the smallest patch beside it. Elements of different regions are in
/// different patches, and quarters of quadrangles, as of crossed meshes, in none.
template <int Dim>
std::vector<int> dilatation_patches(const Grid<Dim>& grid);

}  // namespace suffuse
