#include "scene/grading_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

using End = Gradation::End;

/// H is the mass between d and `size_ratio` d.
constexpr double size_ratio = 4.0;
/// Per cent: a smaller H marks a gap in the curve (Kezdi).
constexpr double level = 15.0;
/// Percentages (absolute) and ratios (relative) with smaller differences are equal.
constexpr double equality_margin = 1e-9;

/// A size at which H/F may be smallest.
struct ShapePoint {
  double size;   ///< d
  double finer;  ///< F
  double above;  ///< H
  [[nodiscard]] double ratio() const { return above / finer; }
};

ShapePoint shape_at(const Gradation& gradation, double size) {
  const double finer = gradation.finer(size);
  return {size, finer, gradation.finer(size_ratio * size) - finer};
}

/// Sizes between which F and H are linear over log d, so that H/F and H are monotone: both are
/// smallest at one of these sizes. Ascending, all with F > 0.
/// \param percentages  values of F whose sizes are added
std::vector<ShapePoint> shape_points(const Gradation& gradation,
                                     const std::vector<double>& percentages) {
  std::vector<double> sizes;
  for (const GradationPoint& point : gradation.points()) {
    sizes.push_back(point.size);
    sizes.push_back(point.size / size_ratio);
  }
  for (const double finer : percentages) {
    if (finer < gradation.smallest_finer()) continue;
    for (const End end : {End::fine, End::coarse}) sizes.push_back(gradation.size(finer, end));
  }
  std::ranges::sort(sizes);
  std::vector<ShapePoint> all;
  for (const double size : sizes) {
    if (size < gradation.smallest_size()) continue;
    const ShapePoint point = shape_at(gradation, size);
    if (point.finer > equality_margin && (all.empty() || size > all.back().size))
      all.push_back(point);
  }
  return all;
}

/// The point with F up to `limit` and the smallest `value`, the last one of several that are equal
/// within round-off; nullptr if there is none.
template <class Value>
const ShapePoint* smallest(const std::vector<ShapePoint>& points, double limit, Value value) {
  const ShapePoint* found = nullptr;
  for (const ShapePoint& point : points) {
    if (point.finer > limit + equality_margin) continue;
    if (!found || value(point) <= value(*found) * (1.0 + equality_margin)) found = &point;
  }
  return found;
}

GradingVerdict unknown(std::string check, const Gradation& gradation, const std::string& needed) {
  return {.check = std::move(check),
          .reason = "needs " + needed +
                    ", but the finest point is at F = " + percent_text(gradation.smallest_finer())};
}

/// d90/d60 and d90/d15.
struct SizeRatios {
  double upper;  ///< h'
  double whole;  ///< h''
};

std::optional<SizeRatios> size_ratios(const Gradation& gradation) {
  if (gradation.smallest_finer() > 15.0 + equality_margin) return std::nullopt;
  const double d90 = gradation.size(90.0);
  return SizeRatios{d90 / gradation.size(60.0), d90 / gradation.size(15.0)};
}

/// D15/d85 of a split at S = u/0.85: d85 of the finer part is the size at u, D15 of the coarser
/// part the size at S + 0.15 (100 - S) = u + 15.
double split_ratio(const Gradation& gradation, double u, End end) {
  return gradation.size(u + 15.0, end) / gradation.size(u, end);
}

}  // namespace

double search_limit(const Gradation& gradation) {
  constexpr double wide = 20.0;
  constexpr double narrow = 30.0;
  // The coarse part starts at F = 30 % of the whole. A percentage of the coarse part becomes a
  // percentage of the whole: 60 % become 72 %, and 10 % become 37 %.
  const auto of_coarse = [](double finer) { return narrow + finer * (100.0 - narrow) / 100.0; };
  if (gradation.smallest_finer() > of_coarse(10.0)) return narrow;
  const double uniformity =
      gradation.size(of_coarse(60.0)) / gradation.size(of_coarse(10.0), End::coarse);
  return uniformity > 3.0 * (1.0 + equality_margin) ? wide : narrow;
}

std::optional<FinesContent> fines_content(const Gradation& gradation) {
  const double limit = search_limit(gradation);
  const std::vector<ShapePoint> points = shape_points(gradation, {limit});
  const ShapePoint* found = smallest(points, limit, [](const auto& p) { return p.ratio(); });
  const auto falls = [&](std::size_t from, std::size_t to) {
    return points[to].ratio() < points[from].ratio() * (1.0 - equality_margin);
  };
  bool at_limit = false;
  if (found) {
    const auto next = static_cast<std::size_t>(found - points.data()) + 1;
    at_limit = next < points.size() && points[next].finer > limit && falls(next - 1, next);
  }
  // At a gap beyond the limit, H/F falls and rises again, perhaps after a level stretch.
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool gap = points[i].finer > limit + equality_margin && points[i].above < level;
    if (!gap || !falls(i - 1, i)) continue;
    std::size_t next = i + 1;
    while (next < points.size() && !falls(i, next) && !falls(next, i)) ++next;
    if (next == points.size() || !falls(next, i)) continue;
    if (!found || points[i].ratio() < found->ratio()) {
      found = &points[i];
      at_limit = false;
    }
  }
  if (!found) return std::nullopt;
  // The finest size of the gap, which is the largest size of the fines.
  return FinesContent{found->finer, gradation.size(found->finer), found->ratio(), at_limit};
}

GradingVerdict check_kezdi(const Gradation& gradation) {
  constexpr double largest_stable = 4.0;
  constexpr double end = 85.0;
  const std::string check = "Kezdi (1979)";
  const double start = gradation.smallest_finer();
  if (start >= end - equality_margin) {
    return unknown(check, gradation, "splits below S = 100 %");
  }
  // The logarithm of the ratio is linear in u between these values and jumps with the sizes.
  std::vector<double> splits{start, end};
  for (const GradationPoint& point : gradation.points()) {
    splits.push_back(point.finer);
    splits.push_back(point.finer - 15.0);
  }
  double largest = 0.0;
  double at = unset;
  for (const double u : splits) {
    if (u < start - equality_margin || u > end + equality_margin) continue;
    for (const End side : {End::fine, End::coarse}) {
      // There is no split before the first and after the last.
      if (std::abs(u - (side == End::fine ? start : end)) <= equality_margin) continue;
      const double ratio = split_ratio(gradation, u, side);
      if (ratio <= largest * (1.0 + equality_margin)) continue;
      largest = ratio;
      at = u / 0.85;
    }
  }
  return {.check = check,
          .stability = largest > largest_stable * (1.0 + equality_margin) ? Stability::unstable
                                                                          : Stability::stable,
          .value = largest,
          .at_finer = at,
          .known_from = start / 0.85,
          .reason = "largest D'15/d'85 is " + three_digits(largest) + ", split at " +
                    percent_text(at) + "; above 4 is unstable"};
}

GradingVerdict check_kenney_lau(const Gradation& gradation) {
  const std::string check = "Kenney and Lau (1986)";
  const double limit = search_limit(gradation);
  const auto points = shape_points(gradation, {limit});
  const auto* found = smallest(points, limit, [](const auto& p) { return p.ratio(); });
  if (!found) return unknown(check, gradation, "sizes up to F = " + percent_text(limit));
  const bool unstable = found->ratio() < 1.0 - equality_margin;
  return {.check = check,
          .stability = unstable ? Stability::unstable : Stability::stable,
          .value = found->ratio(),
          .at_finer = found->finer,
          .known_from = gradation.smallest_finer(),
          .reason = "smallest H/F up to F = " + percent_text(limit) + " is " +
                    three_digits(found->ratio()) + ", at " + percent_text(found->finer) +
                    "; below 1 is unstable"};
}

GradingVerdict check_li_fannin(const Gradation& gradation) {
  const std::string check = "Li and Fannin (2008)";
  const double limit = load_bearing_fines;
  const auto points = shape_points(gradation, {level, limit});
  const auto value = [](const ShapePoint& p) { return p.above / std::min(p.finer, level); };
  const auto* found = smallest(points, limit, value);
  if (!found) return unknown(check, gradation, "sizes up to F = " + percent_text(limit));
  const bool unstable = value(*found) < 1.0 - equality_margin;
  return {.check = check,
          .stability = unstable ? Stability::unstable : Stability::stable,
          .value = value(*found),
          .at_finer = found->finer,
          .known_from = gradation.smallest_finer(),
          .reason = "smallest H/min(F, 15 %) up to F = " + percent_text(limit) + " is " +
                    three_digits(value(*found)) + ", at " + percent_text(found->finer) +
                    "; below 1 is unstable"};
}

GradingVerdict check_burenkova(const Gradation& gradation) {
  const std::string check = "Burenkova (1993)";
  const auto h = size_ratios(gradation);
  if (!h) return unknown(check, gradation, "d15");
  const double low = 0.76 * std::log10(h->whole) + 1.0;
  const double high = 1.86 * std::log10(h->whole) + 1.0;
  return {.check = check,
          .stability = low < h->upper && h->upper < high ? Stability::stable : Stability::unstable,
          .value = h->upper,
          .reason = "d90/d60 = " + three_digits(h->upper) +
                    ", d90/d15 = " + three_digits(h->whole) + "; between " + three_digits(low) +
                    " and " + three_digits(high) + " is stable"};
}

GradingVerdict check_wan_fell(const Gradation& gradation) {
  const std::string check = "Wan and Fell (2008)";
  const auto h = size_ratios(gradation);
  if (!h) return unknown(check, gradation, "d15");
  const double z = 2.378 * std::log10(h->whole) - 3.648 * h->upper + 3.701;
  const double probability = 1.0 / (1.0 + std::exp(-z));
  return {.check = check,
          .stability = probability > 0.5 ? Stability::unstable : Stability::stable,
          .value = probability,
          .reason = "probability of being unstable " + percent_text(100.0 * probability)};
}

std::vector<GradingVerdict> check_grading(const Gradation& gradation) {
  return {check_kezdi(gradation), check_kenney_lau(gradation), check_li_fannin(gradation),
          check_burenkova(gradation), check_wan_fell(gradation)};
}

std::string three_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return shown_number(std::strtod(text.data(), nullptr));
}

std::string percent_text(double value) {
  return three_digits(value) + " %";
}

std::string stability_text(const GradingVerdict& verdict) {
  switch (verdict.stability) {
    case Stability::unknown:
      return "cannot be told";
    case Stability::unstable:
      return "unstable";
    case Stability::stable:
      break;
  }
  return verdict.known_from > 0.0 ? "stable above " + percent_text(verdict.known_from) : "stable";
}

}  // namespace suffuse
