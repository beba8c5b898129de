#pragma once

#include "case/case_file.hpp"
#include "grid/grid.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// The volume that a point erodes is distributed over the field nodes of its element, and those far
/// from the point get a negative share. The sum is right as long as each node keeps a pore volume.
/// Throws InputError.
template <int Dim>
void refuse_points_near_corners(const Case<Dim>& c, const Grid<Dim>& grid,
                                const SoilMap<Dim>& soils);

}  // namespace suffuse
