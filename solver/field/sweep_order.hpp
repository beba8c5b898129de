#pragma once

/// The order of the elements in a sweep along the flow: upwind elements come first. Elements in
/// which liquid circulates (convection, round-off in liquid at rest) have no such order: they form
/// a circle and are adjacent in the order.

#include <vector>

#include "field/element_sides.hpp"

namespace suffuse {

struct SweepOrder {
  struct Circle {
    int begin;  ///< index in `elements`
    int end;
  };
  std::vector<int> elements;
  std::vector<Circle> circles;  ///< in the order of `elements`, each of two elements or more

  /// The largest number of elements in one circle.
  [[nodiscard]] int largest_circle() const;
};

/// Finds the order from the outflow through the sides of each element: strongly connected
/// components by Tarjan (SIAM J. Comput. 1 (1972) 146), which come in upwind order.
template <int Dim>
SweepOrder sweep_order(const ElementSides<Dim>& sides, const ElementField<Dim>& outflow);

}  // namespace suffuse
