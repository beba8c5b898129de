#pragma once

/// Soil that loses its equilibrium repeatedly without moving far: it comes to rest each time, but
/// has no equilibrium there (docs/theory/moving-soil.md, "When soil fails").

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

template <int Dim>
class RepeatedFailure {
 public:
  /// A failure goes nowhere if no point moves by more than this times the mean size of elements
  /// until the next, on average over those in a row.
  static constexpr double way = 0.05;
  /// Share of the loads that may be out of balance while soil rests: what inertia may carry when it
  /// comes to rest. It doubles with each failure in a row, as that much has moved nothing.
  static constexpr double first_share = 1e-2;

  /// Call when the soil has lost its equilibrium. `position`: of each point, always in one order,
  /// m; `size`: of elements, m.
  void fails(const std::vector<Vector<Dim>>& position, double size);
  /// The share of the loads at which soil that rests now moves again; at most 1.
  [[nodiscard]] double held_share() const;

  void archive(auto& archive) { archive(place_, count_); }

 private:
  std::vector<Vector<Dim>> place_;  ///< of the points at the first failure of the row, m
  int count_ = 0;                   ///< of failures in a row
};

}  // namespace suffuse
