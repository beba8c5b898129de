#pragma once

/// The concentration of fines for the weight of the liquid in double-point models.

#include <vector>

#include "grid/grid.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Smooths the concentrations of elements with their liquid volumes, m3. Without it a point that
/// crosses a face would change the weight abruptly and cause eddies in free water, which has little
/// drag. Concentrations in soil are smoothed over neighbouring elements; free water is taken as
/// well mixed.
template <int Dim>
std::vector<double> smoothed_concentration(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                           std::vector<double> concentration,
                                           const std::vector<double>& volume);

}  // namespace suffuse
