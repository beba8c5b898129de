#pragma once

/// Numbers the elements and nodes of a mesh so that neighbours in space are neighbours in memory:
/// elements along Hilbert's curve, nodes in the order of the elements.
///
/// Hilbert's curve passes through all cells of a grid of 2^k cells a side (squares for Dim = 2,
/// cubes for 3), each step into a neighbouring cell. Any part of it fills a compact part of the
/// grid, on every scale: a loop over elements finds its nodes in the cache, and consecutive
/// elements form a part of the model with a short border.

#include <array>
#include <cstdint>

#include "mesh/mesh.hpp"

namespace suffuse {

/// Largest level of the grid for which positions on the curve fit 64 bits.
template <int Dim>
inline constexpr int finest_hilbert_level = 63 / Dim;

/// Position on the curve, from 0, of a cell of the grid of 2^level cells a side. The curve starts
/// at cell 0. Coarser grids agree with finer ones: the cell that contains this one has the position
/// divided by 2^Dim.
/// \param cell   coordinates, each below 2^level
/// \param level  1 to `finest_hilbert_level`
/// J. Skilling, AIP Conf. Proc. 707 (2004) 381-387.
template <int Dim>
std::uint64_t hilbert_position(std::array<std::uint32_t, Dim> cell, int level);

/// Renumbers a mesh. Elements are sorted by the position of their centroids on the curve in the
/// smallest square or cube around the mesh, those with equal positions by their former number.
/// Nodes are numbered in the order in which the sorted elements name them first. The faces of each
/// boundary are sorted by their nodes, ascending. The corners of an element, the regions and the
/// boundaries keep their order. Every node must belong to an element.
template <int Dim>
Mesh<Dim> in_hilbert_order(const Mesh<Dim>& mesh);

}  // namespace suffuse
