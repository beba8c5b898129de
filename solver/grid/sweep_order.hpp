#pragma once

/// The order of the elements in a sweep along the flow: upwind elements come first. Elements in
/// which liquid circulates (convection, round-off in liquid at rest) have no such order: they form
/// a circle and are adjacent in the order.

#include <array>
#include <vector>

namespace suffuse {

/// Elements across the sides of each element; -1: none.
template <int Dim>
using ElementsAcross = std::vector<std::array<int, Dim + 1>>;

struct SweepOrder {
  /// Elements without a circle, or those of a circle.
  struct Part {
    int begin;  ///< index in `elements`
    int end;
    bool is_circle = false;
    /// A circle that several ranks share: on all of them, the ends of the rounds of a pass, in
    /// `elements`. After each, ranks send each other values. Empty for other parts.
    std::vector<int> rounds = {};
    bool sends = false;  ///< ranks send each other values after this part
  };
  std::vector<int> elements;
  std::vector<Part> parts;

  void add(const std::vector<int>& more, bool is_circle);
  /// The largest number of elements in one circle.
  [[nodiscard]] int largest_circle() const;
};

/// Finds the order from the upwind elements of each element: strongly connected components by
/// Tarjan (SIAM J. Comput. 1 (1972) 146), which come in upwind order. The order within a circle
/// depends on its elements only.
template <int Dim>
SweepOrder sweep_order(const ElementsAcross<Dim>& upwind);

}  // namespace suffuse
