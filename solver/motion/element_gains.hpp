#pragma once

/// What the motion of points adds to the solid volume of each element.

#include <vector>

namespace suffuse {

/// Keeps references; vectors per element.
struct GainInput {
  const std::vector<double>& smooth_before;  ///< `smooth_volumes` before the motion, m3
  const std::vector<double>& smooth_after;   ///< after the motion, m3
  const std::vector<double>& solid;          ///< solid volume before, m3
  const std::vector<double>& volume;         ///< of elements, m3
  double travel;                             ///< largest displacement over an element's height
  const std::vector<int>& piece;             ///< see SolidFlux; -1: none
  int piece_count;
};

/// Gain of each element, m3: the change of the smooth volumes, plus part of their earlier
/// difference from the solid volumes, which comes from erosion at single points and from the start.
/// Motion reduces this difference by the factor 1 - travel, or less where an element would get a
/// negative solid volume. So soil that does not move changes nothing. Gains of a piece add up to
/// zero.
std::vector<double> element_gains(const GainInput& input);

}  // namespace suffuse
