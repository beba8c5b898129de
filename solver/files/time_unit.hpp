#pragma once

/// Units of time that users give, and in which results are shown.

#include <optional>
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
/// A time that a user gives, s: `3600`, `2.5d`, `30 min`; nothing for any other text.
std::optional<double> read_time(const std::string& text);
/// "in s, or with a unit behind the number: ...": what messages expect.
std::string time_forms();
/// The unit in which times up to `end` (s) are small numbers.
TimeUnit fitting_time_unit(double end);
/// "6 d"
std::string time_text(double seconds, const TimeUnit& unit);
/// A time in the unit, in six digits: "172800".
std::string time_digits(double seconds, const TimeUnit& unit);
/// A time of a run until `end` (s) in words, "5 h 33 min": to within a hundredth of itself, and so
/// that times `spacing` (s) apart differ.
std::string time_words(double seconds, double end, double spacing);
/// "0, 10 or 20 s"; for many times their number, the first and the last.
std::string shown_times(const std::vector<double>& times);
/// The least distance between two of these times, s; infinite for fewer than two.
double least_spacing(std::vector<double> times);

}  // namespace suffuse
