#pragma once

/// Whether a filter holds back the grains of the soil that it protects, its base: Terzaghi's
/// criteria, and the boundaries of erosion of Foster and Fell (2001), by gradations.

#include <optional>

#include "scene/grading_checks.hpp"

namespace suffuse {

/// Largest D15 of the filter, mm, up to which the base erodes not, not excessively, and not for
/// ever.
struct ErosionBoundaries {
  double none = 0.0;
  /// Nothing for bases with D95 > 2 mm and more than 35 % of fines: their boundary is a chart.
  std::optional<double> excessive;
  double continuing = 0.0;
};

/// For a base that is not dispersive. Sizes over 4.75 mm are left out of the base. Fines are grains
/// below 0.075 mm; a gradation that begins above that has none.
///
/// none: Fell and others, Geotechnical Engineering of Dams, table 9.2 (of existing filters, without
/// a margin). excessive, continuing: Foster and Fell (2001).
/// Nothing where the gradation begins above the sizes that decide.
std::optional<ErosionBoundaries> erosion_boundaries(const Gradation& base);

/// What a filter has to hold: of a soil that is unstable by Kenney and Lau's or Li and Fannin's
/// criterion only its fines, as the coarse grains do not hold them (ICOLD bulletin 164); otherwise
/// all of it. Kezdi's splits also find the thin fine end of stable soils, which is no base.
struct FilterBase {
  Gradation gradation;
  double finer = 100.0;  ///< share of the soil, per cent
};
FilterBase filter_base(const Gradation& soil);

/// Size that `percent` of the mass are finer than, mm; nothing where the gradation begins above
/// that.
std::optional<double> size_at(const Gradation& gradation, double percent);

/// D15F / D85B, which must be at most 4 so that the filter holds the base (Terzaghi).
std::optional<double> retention_ratio(const Gradation& base, const Gradation& filter);
/// D15F / D15B, which must be at least 4 so that the filter drains the base (Terzaghi).
std::optional<double> drainage_ratio(const Gradation& base, const Gradation& filter);
inline constexpr double terzaghi_ratio = 4.0;

}  // namespace suffuse
