#pragma once

/// Keeps holes out of soil whose points have moved through elements.

#include "solid/solid_points.hpp"
#include "solid/supports.hpp"

namespace suffuse {

/// Where soil has moved by more than an element, an element inside it may have no point: it would
/// act as a cavity, though the soil around it has grown no looser. A neighbour with two points or
/// more then gives it the nearest one, moved over their common face. Elements without points at a
/// free outer face or at a node without soil, and others that they reach, may be room that the soil
/// has left or has never filled: they stay empty. Rigid soil neither gives points nor takes them.
/// \param start  places of the points at the start, m: they move with the points
template <int Dim>
void fill_holes(const Grid<Dim>& grid, const Supports<Dim>& supports, SolidPoints<Dim>& points,
                std::vector<Vector<Dim>>& start);

}  // namespace suffuse
