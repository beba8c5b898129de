#pragma once

/// Fits a concentration field to liquid points, for output.

#include "grid/element_field.hpp"
#include "points/liquid_points.hpp"

namespace suffuse {

/// Linear function per element, by least squares over the liquid points of the element and of its
/// neighbours across faces in the same region, weighted with their volumes; further neighbours join
/// where these are too few or lie on one line, and after four rounds the mean takes the function's
/// place (0 where there is no liquid at all). Values at the element's field nodes; not clipped to
/// [0, 1). `begins`: points of each element; `volume`: liquid volume per point, m3.
template <int Dim>
ElementField<Dim> concentration_fit(const Grid<Dim>& grid, const LiquidPoints<Dim>& points,
                                    const std::vector<int>& begins,
                                    const std::vector<double>& volume,
                                    const std::vector<double>& concentration);

}  // namespace suffuse
