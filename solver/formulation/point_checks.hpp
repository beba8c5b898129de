#pragma once

#include "case/case_file.hpp"
#include "grid/grid.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Throws InputError if the pore volume at a field node could become negative: the exchange of a
/// point is distributed to the field nodes of its element, with negative shares for nodes far from
/// the point.
template <int Dim>
void refuse_points_near_corners(const Case<Dim>& c, const Grid<Dim>& grid,
                                const SoilMap<Dim>& soils);

}  // namespace suffuse
