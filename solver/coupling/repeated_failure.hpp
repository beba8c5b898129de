#pragma once

/// Soil that loses its equilibrium again and again without going anywhere: each time it rests, and
/// no state in which it stands is found there (docs/theory.md, "Inertia of the soil").

#include <vector>

#include "equilibrium/solid_points.hpp"

namespace suffuse {

template <int Dim>
class RepeatedFailure {
 public:
  /// More failures in a row are creep, if no point moves farther from one to the next, on average,
  /// than `way` times the mean size of elements.
  static constexpr int most = 10;
  static constexpr double way = 0.05;
  /// Soil that has lain still stands if it is in equilibrium for so many times of its fall.
  static constexpr double standing = 10.0;

  /// The soil has come to rest with its inertia, at `time`, s. `fall`: the time in which it would
  /// fall through its height, s.
  void rests(double time, double fall) { stands_from_ = time + standing * fall; }
  /// The soil has lost its equilibrium at `time`, s. `position`: of each point, in an order that
  /// stays, m; `size`: of elements, m.
  void fails(double time, const std::vector<Vector<Dim>>& position, double size);
  /// Throws EquilibriumLost: the soil creeps.
  /// \param time  of the last equilibrium, s
  [[noreturn]] void refuse_creep(double time, const std::vector<Vector<Dim>>& position) const;

  /// Whether it has lost it so often in a row that it creeps.
  [[nodiscard]] bool is_creep() const { return count_ > most; }
  void archive(auto& archive) { archive(place_, first_, stands_from_, count_); }

 private:
  /// The point that has moved most since the first of the failures.
  [[nodiscard]] int farthest(const std::vector<Vector<Dim>>& position) const;

  std::vector<Vector<Dim>> place_;  ///< of the points at the first failure in a row, m
  double first_ = 0.0;              ///< its time, s
  double stands_from_ = 0.0;        ///< what fails later did stand, s
  int count_ = 0;                   ///< of failures in a row
};

}  // namespace suffuse
