#pragma once

/// How much of each element the soil fills, as far as its stress is concerned.

#include <vector>

#include "equilibrium/solid_points.hpp"

namespace suffuse {

/// Inside the soil an element is full: its mean stress fills it, whatever the volumes of its points
/// are. At the surface it counts as far as its points do. Between the two it goes over without a
/// jump, with the share of the volume around its nodes that soil fills: a jump would load the pore
/// water at once, however short the step.
struct ElementClasses {
  /// \param points  sorted by the elements of the grid
  template <int Dim>
  ElementClasses(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                 const PointsByElement& sorted);

  /// Per element: 1 where it is full, 0 where it counts as its points do, or has none.
  std::vector<double> full;
  /// Per element, what a volume of its points counts for in the integral of the stress: in full
  /// elements V_e over the sum of the points' volumes, so that the mean stress fills the element; 1
  /// where it counts as they do; 0 where there are none.
  std::vector<double> scale;
};

/// Volume that counts as soil, per element, m3: all of a full one.
template <int Dim>
std::vector<double> soil_volumes(const SolidPoints<Dim>& points, const PointsByElement& sorted,
                                 const ElementClasses& classes);

}  // namespace suffuse
