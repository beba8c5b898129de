#pragma once

/// Soil that loses its equilibrium repeatedly without moving far: it comes to rest each time, but
/// has no equilibrium there (docs/theory.md, "Inertia of the soil").

#include <vector>

#include "equilibrium/solid_points.hpp"

namespace suffuse {

template <int Dim>
class RepeatedFailure {
 public:
  /// More failures in a row are creep if, on average, no point moves by more than `way` times the
  /// mean size of elements from one to the next.
  static constexpr int most = 10;
  static constexpr double way = 0.05;
  /// A row of failures ends if the soil is in equilibrium for this many times of its fall.
  static constexpr double standing = 10.0;

  /// Call when soil with inertia has come to rest at `time`, s. `fall`: time of a fall through its
  /// height, s.
  void rests(double time, double fall) { stands_from_ = time + standing * fall; }
  /// Call when the soil has lost its equilibrium at `time`, s. `position`: of each point, always in
  /// one order, m; `size`: of elements, m.
  void fails(double time, const std::vector<Vector<Dim>>& position, double size);
  /// Throws EquilibriumLost: the soil creeps.
  /// \param time  of the last equilibrium, s
  [[noreturn]] void refuse_creep(double time, const std::vector<Vector<Dim>>& position) const;

  /// Whether the soil has failed so often in a row that it creeps.
  [[nodiscard]] bool is_creep() const { return count_ > most; }
  void archive(auto& archive) { archive(place_, first_, stands_from_, count_); }

 private:
  /// The point that has moved most since the first of the failures.
  [[nodiscard]] int farthest(const std::vector<Vector<Dim>>& position) const;

  std::vector<Vector<Dim>> place_;  ///< of the points at the first failure of the row, m
  double first_ = 0.0;              ///< of the first failure of the row, s
  double stands_from_ = 0.0;        ///< the row has ended if soil fails later, s
  int count_ = 0;                   ///< of failures in a row
};

}  // namespace suffuse
