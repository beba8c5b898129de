#pragma once

/// The gradation of a soil: the share of its grains, by mass, that is finer than each size.

#include <optional>
#include <string>
#include <vector>

namespace suffuse {

/// A point of the curve, for example from a sieve.
struct GradationPoint {
  double size = 0.0;   ///< d, mm
  double finer = 0.0;  ///< F, per cent by mass
};

/// The curve is linear between points, in per cent over log d. It is unknown below the first point,
/// unless this point is at 0 %.
class Gradation {
 public:
  Gradation() = default;
  /// \param points  as `gradation_fault` accepts them
  explicit Gradation(std::vector<GradationPoint> points) : points_(std::move(points)) {}

  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] const std::vector<GradationPoint>& points() const { return points_; }

  /// Size, mm, and percentage of the first point.
  [[nodiscard]] double smallest_size() const { return points_.front().size; }
  [[nodiscard]] double smallest_finer() const { return points_.front().finer; }

  /// Which size of a percentage is meant in a gap, where the curve is level between a fine and a
  /// coarse end.
  enum class End { fine, coarse };

  /// F at a size, per cent: 100 beyond the last point. The size must not be below the first.
  [[nodiscard]] double finer(double size) const;
  /// d at a percentage, mm. The percentage must not be below the first.
  [[nodiscard]] double size(double finer, End end = End::fine) const;

 private:
  [[nodiscard]] double between(std::size_t i, double finer) const;

  std::vector<GradationPoint> points_;
};

/// The fault of a table [[d, F], ...] as a gradation, if one entry is wrong:
/// `F = 60 % at d = 4 mm after F = 70 %`. Empty if there is none.
std::string gradation_fault(const std::vector<std::vector<double>>& rows);

}  // namespace suffuse
