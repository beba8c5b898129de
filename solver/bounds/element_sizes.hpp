#pragma once

/// Sizes of elements for the next mesh, from each element's part in the error.

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// Edge length of a regular triangle or tetrahedron as large as each element, m.
template <int Dim>
std::vector<double> element_sizes(const Grid<Dim>& grid);

struct WantedError {
  double whole = 0.0;         ///< sum over the elements that the next mesh is to have, in that unit
  double max_elements = 0.0;  ///< of the next mesh
};

/// Size at each node, m: with it the errors of all elements are equal and add up to what is wanted,
/// if the error of an element falls as h^(Dim + 2). An element of the next mesh is at least 0.35
/// and at most 1.5 times as large as the one before it.
template <int Dim>
std::vector<double> next_sizes(const Grid<Dim>& grid, const std::vector<double>& error,
                               const WantedError& wanted);

}  // namespace suffuse
