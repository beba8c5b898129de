#pragma once

/// How much of each element the soil fills, as far as its stress is concerned.

#include <vector>

#include "deformation/solid_points.hpp"

namespace suffuse {

/// An element is full where each element that shares a node with it holds a point. This asks for
/// no volume: a limit on the volume takes sparse inner elements for partial ones.
enum class ElementClass : char { empty, partial, full };

struct ElementClasses {
  /// \param points  sorted by the elements of the grid
  template <int Dim>
  ElementClasses(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                 const PointsByElement& sorted);

  std::vector<ElementClass> kind;  ///< per element
  /// Per element, what a volume of its points counts for in the integral of the stress: in full
  /// elements V_e over the sum of the points' volumes, so that the mean stress fills the element; 1
  /// in partial ones; 0 in empty ones.
  std::vector<double> scale;
};

}  // namespace suffuse
