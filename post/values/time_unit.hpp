#pragma once

/// Units of time in which results are shown.

#include <string>
#include <vector>

namespace suffuse {

/// A unit of time: s, min, h, d, or a of 365.25 d.
struct TimeUnit {
  std::string name = "s";
  double seconds = 1.0;
};

/// All units, ascending.
const std::vector<TimeUnit>& time_units();
/// The unit in which times up to `end` (s) are small numbers.
TimeUnit fitting_time_unit(double end);
/// "6 d"
std::string time_text(double seconds, const TimeUnit& unit);

}  // namespace suffuse
