#pragma once

/// Fits a concentration field to liquid points, for output.

#include "grid/element_field.hpp"
#include "points/liquid_points.hpp"

namespace suffuse {

/// Linear function per element by least squares, weighted with volumes, over the liquid points of
/// the element and of its neighbours in the same region. If these are too few or collinear, further
/// neighbours are added, in up to four rounds; then the mean is used (0 without liquid). Returns
/// values at field nodes, not clipped to [0, 1). `begins`: points of each element; `volume`: liquid
/// volume per point, m3.
template <int Dim>
ElementField<Dim> concentration_fit(const Grid<Dim>& grid, const LiquidPoints<Dim>& points,
                                    const std::vector<int>& begins,
                                    const std::vector<double>& volume,
                                    const std::vector<double>& concentration);

}  // namespace suffuse
