#pragma once

/// Whether the fines of a soil can move between its coarse grains, judged by its gradation alone:
/// criteria from the literature, with sources. docs/theory/exchange.md, "Gradings".
///
/// F: mass finer than d; H: mass between d and 4 d; both in per cent of the whole.

#include <optional>
#include <string>
#include <vector>

#include "physics/local_state.hpp"
#include "scene/gradation.hpp"

namespace suffuse {

/// `unknown`: the check needs sizes below the first point of the gradation.
enum class Stability { stable, unstable, unknown };

/// Result of one criterion.
struct GradingVerdict {
  std::string check;  ///< "Kenney and Lau (1986)"
  Stability stability = Stability::unknown;
  double value = unset;     ///< the number that decides; unset if unknown
  double at_finer = unset;  ///< F of `value`, or S of a split, per cent; unset for whole curves
  /// F below which the gradation lacks points that the check needs, per cent; 0: complete.
  double known_from = 0.0;
  std::string reason;  ///< number and limit, or the missing sizes
};

/// The grains that are loose between the others, estimated from the gradation.
struct FinesContent {
  double finer = unset;   ///< F*, per cent, at the smallest H/F
  double size = unset;    ///< d there, mm
  double ratio = unset;   ///< H/F there
  bool at_limit = false;  ///< no gap: H/F still falls at the end of the search
};

/// Above this percentage fines carry load, and the coarse grains float in them.
inline constexpr double load_bearing_fines = 35.0;

/// Largest F of the search for loose grains: 20 %, or 30 % if the coarse grains have about one
/// size, C_u = D60/D10 <= 3 of what is coarser than at F = 30 % (Kenney and Lau 1985).
double search_limit(const Gradation& gradation);

/// F* at the smallest H/F, for F up to the limit of the search, and at gaps beyond: sizes with H <
/// 15 % at which H/F is smaller than on both sides. Nothing if the gradation starts beyond the
/// limit and has no gap.
std::optional<FinesContent> fines_content(const Gradation& gradation);

/// Every split into a finer and a coarser soil, at F = S: D15 of the coarser over d85 of the finer
/// above 4 is unstable.
GradingVerdict check_kezdi(const Gradation& gradation);
/// H/F < 1 at some F up to the limit of the search is unstable.
GradingVerdict check_kenney_lau(const Gradation& gradation);
/// H < min(F, 15 %) at some F up to that of fines that carry load is unstable.
GradingVerdict check_li_fannin(const Gradation& gradation);
/// 0.76 log h'' + 1 < h' < 1.86 log h'' + 1 is stable; h' = d90/d60, h'' = d90/d15.
GradingVerdict check_burenkova(const Gradation& gradation);
/// P = 1/(1 + exp(-Z)), Z = 2.378 log h'' - 3.648 h' + 3.701; above one half is unstable.
GradingVerdict check_wan_fell(const Gradation& gradation);

/// The verdicts of all checks above, in their order.
std::vector<GradingVerdict> check_grading(const Gradation& gradation);

/// A number with three digits, the accuracy of gradations.
std::string three_digits(double value);
/// A percentage in three digits, with its sign.
std::string percent_text(double value);

/// `stable`, `unstable` or `cannot be told`; `stable above 5 %` if the finer part is not given.
std::string stability_text(const GradingVerdict& verdict);

}  // namespace suffuse
