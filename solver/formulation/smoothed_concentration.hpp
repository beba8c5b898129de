#pragma once

/// The concentration of fines from which the weight of the liquid is found in double-point models.

#include <vector>

#include "grid/grid.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// From the concentrations of the elements and their liquid volumes, m3. A point that crosses a
/// face would make the buoyancy jump, and free water, which resists flow very little, would turn in
/// eddies. So concentrations in soil are smoothed over the elements around, and free water counts
/// as well mixed.
template <int Dim>
std::vector<double> smoothed_concentration(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                           std::vector<double> concentration,
                                           const std::vector<double>& volume);

}  // namespace suffuse
