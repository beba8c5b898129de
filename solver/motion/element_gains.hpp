#pragma once

/// What the motion of points adds to the solid volume of each element.

#include <vector>

namespace suffuse {

/// Refers to what the caller keeps; vectors per element.
struct GainInput {
  const std::vector<double>& smooth_before;  ///< `smooth_volumes` before the motion, m3
  const std::vector<double>& smooth_after;   ///< and after it, m3
  const std::vector<double>& solid;          ///< solid volume before, m3
  const std::vector<double>& volume;         ///< of elements, m3
  double travel;                             ///< largest displacement over an element's height
  const std::vector<int>& piece;             ///< see SolidFlux; -1: none
  int piece_count;
};

/// Gain of each element, m3: the change of the smooth volumes, and a part of what they differed by
/// before. That difference, which erosion at single points makes and the start, goes as the soil
/// moves by an element: it is multiplied by 1 - travel, or less where an element would come to have
/// a negative solid volume. So soil that stays in place changes nothing. Gains of a piece add up to
/// zero.
std::vector<double> element_gains(const GainInput& input);

}  // namespace suffuse
