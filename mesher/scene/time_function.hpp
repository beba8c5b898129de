#pragma once

/// A value that may change in time, as a boundary condition of the scene gives it.

#include <array>
#include <utility>
#include <vector>

namespace suffuse {

/// Linear between its knots, constant before the first and after the last.
struct TimeFunction {
  /// A constant. Implicit, because most boundary values are plain numbers.
  TimeFunction(double value) : knots{{0.0, value}} {}  // NOLINT(google-explicit-constructor)
  /// \param pairs  of time (s) and value: at least one, times strictly ascending
  explicit TimeFunction(std::vector<std::pair<double, double>> pairs) : knots(std::move(pairs)) {}

  [[nodiscard]] double value(double time) const;
  /// Its change per second right after `time`.
  [[nodiscard]] double slope(double time) const;
  /// Whether the value is the same at all times, given as a number or as a table.
  [[nodiscard]] bool is_constant() const;
  [[nodiscard]] double smallest() const;
  [[nodiscard]] double largest() const;
  /// Smallest and largest value in [begin, end].
  [[nodiscard]] std::pair<double, double> range(double begin, double end) const;
  [[nodiscard]] std::vector<double> breakpoints() const;

  friend bool operator==(const TimeFunction&, const TimeFunction&) = default;

  std::vector<std::pair<double, double>> knots;  ///< (s, value), times strictly ascending
};

/// A vector that may change in time, in the same way.
struct VectorFunction {
  using Components = std::array<double, 3>;

  [[nodiscard]] Components value(double time) const;
  [[nodiscard]] std::vector<double> breakpoints() const;

  friend bool operator==(const VectorFunction&, const VectorFunction&) = default;

  std::vector<std::pair<double, Components>> knots;  ///< (s, value), times strictly ascending
  std::size_t given = 3;  ///< components that the scene gives; the others are 0
};

}  // namespace suffuse
