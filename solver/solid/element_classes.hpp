#pragma once

/// The share of each element that its stress fills.

#include <vector>

#include "solid/solid_points.hpp"

namespace suffuse {

/// An element inside the soil is full: its mean stress fills it, whatever the volumes of its
/// points. An element at the surface counts by the volumes of its points. The transition is
/// continuous in the share of the volume around its nodes that soil fills: a jump would load the
/// pore water at once, however short the step.
struct ElementClasses {
  /// \param points  sorted by the elements of the grid
  template <int Dim>
  ElementClasses(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                 const PointsByElement& sorted);

  /// Per element: 1 if it is full, 0 if it counts by its points or has none.
  std::vector<double> full;
  /// Per element: factor on the volumes of its points in the integral of the stress. In full
  /// elements it is V_e over the sum of these volumes, so that the mean stress fills the element; 1
  /// where an element counts by its points; 0 without points.
  std::vector<double> scale;
};

/// Volume that counts as soil, per element, m3: the whole volume of a full element.
template <int Dim>
std::vector<double> soil_volumes(const SolidPoints<Dim>& points, const PointsByElement& sorted,
                                 const ElementClasses& classes);

/// Sum of the points' values in each element, times a factor.
template <int Dim>
std::vector<double> sums_in_elements(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                     const std::vector<double>& values, double factor);

}  // namespace suffuse
