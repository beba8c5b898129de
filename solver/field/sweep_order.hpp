#pragma once

/// The order in which one sweep along the flow finds the concentration in every element: those that
/// the liquid comes from first. Elements that the liquid goes around in (convection, round-off of
/// still liquid) have no such order among themselves: they are a circle and stand together.

#include <vector>

#include "field/element_sides.hpp"

namespace suffuse {

struct SweepOrder {
  struct Circle {
    int begin;  ///< among `elements`
    int end;
  };
  std::vector<int> elements;
  std::vector<Circle> circles;  ///< in the order of `elements`, each of two elements or more

  /// The largest number of elements in one circle.
  [[nodiscard]] int largest_circle() const;
};

/// `outflow` through the sides of each element. Strongly connected components by Tarjan (SIAM J.
/// Comput. 1 (1972) 146), which come in the order that is wanted, and neighbours near each other.
template <int Dim>
SweepOrder sweep_order(const ElementSides<Dim>& sides, const ElementField<Dim>& outflow);

}  // namespace suffuse
