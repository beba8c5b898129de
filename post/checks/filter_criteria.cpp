#include "checks/filter_criteria.hpp"

namespace suffuse {
namespace {

constexpr double largest_size = 4.75;   // mm, to which the base is regraded
constexpr double largest_fine = 0.075;  // mm

/// A base without its grains over 4.75 mm.
class RegradedBase {
 public:
  explicit RegradedBase(const Gradation& base)
      : base_(base),
        kept_(largest_size > base.smallest_size() ? base.finer(largest_size) : 100.0) {}

  /// Whether the gradation says how much is fine, and where 85 % of the rest lies.
  [[nodiscard]] bool is_known() const {
    const bool unknown_below = base_.smallest_finer() > 0.0;
    return !unknown_below ||
           (largest_fine >= base_.smallest_size() && 0.85 * kept_ >= base_.smallest_finer());
  }
  /// Size, mm, that a percentage of the rest is finer than: at least the first one known.
  [[nodiscard]] double size(double percent) const {
    const double finer = percent * kept_ / 100.0;
    return finer < base_.smallest_finer() ? base_.smallest_size() : base_.size(finer);
  }
  /// Per cent.
  [[nodiscard]] double fines() const {
    if (largest_fine < base_.smallest_size()) return 0.0;
    return 100.0 * base_.finer(largest_fine) / kept_;
  }

 private:
  const Gradation& base_;
  double kept_;  // per cent of all
};

/// Boundary of no erosion of soils with 15 to 35 % of fines by design (Sherard and Dunnigan).
double design_boundary(const RegradedBase& base) {
  return (35.0 - base.fines()) / 20.0 * (4.0 * base.size(85.0) - 0.7) + 0.7;
}

double no_erosion(const RegradedBase& base) {
  const double fines = base.fines();
  if (fines >= 85.0) return 9.0 * base.size(85.0);
  if (fines > 35.0) return 0.7;
  if (fines >= 15.0) return 1.6 * design_boundary(base);
  return 7.0 * base.size(85.0);
}

std::optional<double> excessive_erosion(const RegradedBase& base) {
  const double d95 = base.size(95.0);
  if (d95 < 0.3) return 9.0 * d95;
  if (d95 <= 2.0) return 9.0 * base.size(90.0);
  if (base.fines() > 35.0) return std::nullopt;
  if (base.fines() >= 15.0) return 2.5 * design_boundary(base);
  return 9.0 * base.size(85.0);
}

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return std::nullopt;
  return *a / *b;
}

}  // namespace

FilterBase filter_base(const Gradation& soil) {
  const std::optional<FinesContent> fines = fines_content(soil);
  const bool is_unstable = check_kenney_lau(soil).stability == Stability::unstable ||
                           check_li_fannin(soil).stability == Stability::unstable;
  if (!is_unstable || !fines) return {soil};
  std::vector<GradationPoint> points;
  for (const GradationPoint& point : soil.points()) {
    if (point.size >= fines->size) break;
    points.push_back({point.size, 100.0 * point.finer / fines->finer});
  }
  points.push_back({fines->size, 100.0});
  return {Gradation(points), fines->finer};
}

std::optional<ErosionBoundaries> erosion_boundaries(const Gradation& base) {
  const RegradedBase regraded(base);
  if (!regraded.is_known()) return std::nullopt;
  return ErosionBoundaries{no_erosion(regraded), excessive_erosion(regraded),
                           9.0 * regraded.size(95.0)};
}

std::optional<double> size_at(const Gradation& gradation, double percent) {
  if (percent < gradation.smallest_finer()) return std::nullopt;
  return gradation.size(percent);
}

std::optional<double> retention_ratio(const Gradation& base, const Gradation& filter) {
  return ratio(size_at(filter, 15.0), size_at(base, 85.0));
}

std::optional<double> drainage_ratio(const Gradation& base, const Gradation& filter) {
  return ratio(size_at(filter, 15.0), size_at(base, 15.0));
}

}  // namespace suffuse
