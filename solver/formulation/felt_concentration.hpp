#pragma once

/// The concentration of fines that the weight of the liquid goes by where liquid points carry it.

#include <vector>

#include "grid/grid.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// From the concentrations of the elements and their liquid volumes, m3. A point that crosses a
/// face would be a jump of the buoyancy, and free water, which next to nothing resists, would
/// answer it with eddies of its own. So in soil concentrations are smoothed over the elements
/// around, and free water is taken as well mixed.
template <int Dim>
std::vector<double> felt_concentration(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                       std::vector<double> concentration,
                                       const std::vector<double>& volume);

}  // namespace suffuse
