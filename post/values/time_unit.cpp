#include "values/time_unit.hpp"

#include "files/number_text.hpp"

namespace suffuse {

const std::vector<TimeUnit>& time_units() {
  static const std::vector<TimeUnit> units{
      {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}, {"a", 365.25 * 86400.0}};
  return units;
}

TimeUnit fitting_time_unit(double end) {
  TimeUnit fitting;
  for (const TimeUnit& unit : time_units()) {
    if (end >= 2.0 * unit.seconds && end >= 600.0) fitting = unit;
  }
  return fitting;
}

std::string time_text(double seconds, const TimeUnit& unit) {
  return short_text(seconds / unit.seconds) + " " + unit.name;
}

}  // namespace suffuse
