#pragma once

/// The element that holds a place near another element.

#include "grid/grid.hpp"

namespace suffuse {

/// The element that holds a place, from an element nearby, or the one at the border that the place
/// lies little over, with a barycentric coordinate down to -0.5; -1 farther outside the mesh.
template <int Dim>
int element_at(const Grid<Dim>& grid, int start, const Vector<Dim>& x);

}  // namespace suffuse
