#pragma once

/// Depth of soil below its surface.

#include <vector>

#include "solid/soil_map.hpp"
#include "solid/solid_points.hpp"
#include "solid/supports.hpp"

namespace suffuse {

/// Distance of each point to the nearest surface of the soil, m; infinite if there is none.
/// Surfaces are faces between elements with points and those without, and faces at the border of
/// the model that supports do not hold along their normal.
template <int Dim>
std::vector<double> depths_below_surface(const Grid<Dim>& grid, const Supports<Dim>& supports,
                                         const SolidPoints<Dim>& points,
                                         const PointsByElement& sorted);

}  // namespace suffuse
