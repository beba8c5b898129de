#include "scene/gradation.hpp"

#include <algorithm>
#include <cmath>

#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

/// Range of the sizes of grains, mm: other sizes are mistakes.
constexpr double smallest_grain = 1e-6;
constexpr double largest_grain = 1e6;
/// Percentages with smaller differences are equal.
constexpr double percentage_margin = 1e-9;

}  // namespace

double Gradation::finer(double size) const {
  if (size >= points_.back().size) return points_.back().finer;
  const auto upper = std::ranges::upper_bound(points_, size, {}, &GradationPoint::size);
  const GradationPoint& b = *upper;
  const GradationPoint& a = *std::prev(upper);
  return a.finer + (b.finer - a.finer) * std::log(size / a.size) / std::log(b.size / a.size);
}

/// The size for a percentage between those of points i and i + 1.
double Gradation::between(std::size_t i, double finer) const {
  const GradationPoint& a = points_[i];
  const GradationPoint& b = points_[i + 1];
  return a.size * std::pow(b.size / a.size, (finer - a.finer) / (b.finer - a.finer));
}

double Gradation::size(double finer, End end) const {
  if (end == End::fine) {
    std::size_t i = 0;
    while (i + 1 < points_.size() && points_[i].finer < finer - percentage_margin) ++i;
    return points_[i].finer <= finer + percentage_margin || i == 0 ? points_[i].size
                                                                   : between(i - 1, finer);
  }
  std::size_t i = points_.size() - 1;
  while (i > 0 && points_[i].finer > finer + percentage_margin) --i;
  return points_[i].finer >= finer - percentage_margin || i + 1 == points_.size()
             ? points_[i].size
             : between(i, finer);
}

std::string gradation_fault(const std::vector<std::vector<double>>& rows) {
  const auto entry = [](const GradationPoint& point) {
    return "F = " + shown_number(point.finer) + " % at d = " + shown_number(point.size) + " mm";
  };
  GradationPoint earlier;
  for (const std::vector<double>& row : rows) {
    const bool first = &row == rows.data();
    if (row.size() != 2) {
      return "entry " + std::to_string(&row - rows.data() + 1) + ", " + shown_value(row);
    }
    const GradationPoint point{row[0], row[1]};
    if (!(point.size >= smallest_grain && point.size <= largest_grain)) {
      return "d = " + shown_number(point.size) + " mm";
    }
    if (!first && point.size <= earlier.size) {
      return "d = " + shown_number(point.size) + " mm after d = " + shown_number(earlier.size) +
             " mm";
    }
    if (!(point.finer >= 0.0 && point.finer <= 100.0)) return entry(point);
    if (!first && point.finer < earlier.finer) {
      return entry(point) + " after F = " + shown_number(earlier.finer) + " %";
    }
    earlier = point;
  }
  if (rows.size() < 3) {
    return std::to_string(rows.size()) + (rows.size() == 1 ? " point" : " points");
  }
  return earlier.finer < 100.0 ? entry(earlier) + ", the last" : "";
}

}  // namespace suffuse
