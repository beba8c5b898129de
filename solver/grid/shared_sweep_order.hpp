#pragma once

/// The order of a sweep that several ranks share, in rounds: a rank takes its own elements of which
/// all upwind elements are known, then ranks send each other what they found (Plimpton and others,
/// Nucl. Sci. Eng. 150 (2005) 267). Each element gets the values that it has in one process.

#include "grid/grid.hpp"
#include "grid/sweep_order.hpp"

namespace suffuse {

/// Own elements in order. All ranks have to call it; their orders have the same number of parts
/// that send, and of rounds in them. \param upwind  per element that is here: of own elements
template <int Dim>
SweepOrder shared_sweep_order(const Grid<Dim>& grid, const ElementsAcross<Dim>& upwind);

}  // namespace suffuse
