#pragma once

/// Which elements share their dilatation (`SharedDilatation`).

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// Patch of each element, -1: the element is in no patch. Triangles are joined in pairs, across
/// their longest sides first. A patch of tetrahedra grows to four, each time by the neighbour that
/// shares most nodes with it. An element that is left over joins the smallest patch next to it.
/// Elements of different regions are in different patches. The four triangles of a crossed
/// quadrangle belong to no patch.
template <int Dim>
std::vector<int> dilatation_patches(const Grid<Dim>& grid);

}  // namespace suffuse
