#pragma once

/// The element that holds a place near another element.

#include "grid/grid.hpp"

namespace suffuse {

/// The element that holds a place, found from an element nearby. A place outside, with a
/// barycentric coordinate down to -0.5, belongs to the element at the border; farther outside: -1.
template <int Dim>
int element_at(const Grid<Dim>& grid, int start, const Vector<Dim>& x);

}  // namespace suffuse
