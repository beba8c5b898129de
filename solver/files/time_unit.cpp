#include "files/time_unit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/closest_name.hpp"
#include "files/number_text.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {

const std::vector<TimeUnit>& time_units() {
  static const std::vector<TimeUnit> units{
      {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}, {"a", 365.25 * 86400.0}};
  return units;
}

std::optional<double> read_time(const std::string& text) {
  if (const auto seconds = parse_number(text)) return seconds;
  for (const TimeUnit& unit : time_units()) {
    if (!text.ends_with(unit.name)) continue;
    std::string number = text.substr(0, text.size() - unit.name.size());
    while (number.ends_with(' ')) number.pop_back();
    if (const auto count = parse_number(number)) return *count * unit.seconds;
  }
  return std::nullopt;
}

std::string time_forms() {
  std::vector<std::string> names;
  for (const TimeUnit& unit : time_units()) names.push_back(unit.name);
  return "in s, or with a unit behind the number, " + quoted_list(names) + ", as 2.5d";
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

std::string time_digits(double seconds, const TimeUnit& unit) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", seconds / unit.seconds);
  return text;
}

std::string time_words(double seconds, double end, double spacing) {
  constexpr double year = 365.25 * 86400.0;
  const TimeUnit coarsest = fitting_time_unit(end);
  const double step = std::min(0.01 * std::abs(seconds), spacing);
  if (!(step > 0.0)) return "0 " + coarsest.name;
  if (coarsest.seconds >= year && step >= 1e-4 * seconds) return time_text(seconds, coarsest);
  TimeUnit finest;
  for (const TimeUnit& unit : time_units()) {
    if (unit.seconds <= std::min(step, coarsest.seconds)) finest = unit;
  }
  const double power = std::pow(10.0, std::clamp(std::ceil(-std::log10(step)), 0.0, 15.0));
  const double parts_per_second = finest.seconds > 1.0 ? 1.0 / finest.seconds : power;
  double parts = std::round(seconds * parts_per_second);
  std::string text;
  const std::vector<TimeUnit>& units = time_units();
  for (std::size_t i = units.size(); i-- > 0;) {  // the coarsest first
    const TimeUnit& unit = units[i];
    if (unit.seconds > coarsest.seconds || unit.seconds < finest.seconds) continue;
    const double size = unit.seconds * parts_per_second;
    const bool last = unit.seconds == finest.seconds;
    const double count = last ? parts / size : std::floor(parts / size + 1e-9);
    parts -= count * size;
    if (count > 0.0) text += (text.empty() ? "" : " ") + number_text(count) + " " + unit.name;
  }
  return text;
}

std::string shown_times(const std::vector<double>& times) {
  constexpr std::size_t most = 10;
  std::vector<std::string> texts(times.size());
  std::ranges::transform(times, texts.begin(), shown_number);
  if (times.size() <= most) return listed(texts) + " s";
  return std::to_string(times.size()) + " times from " + texts.front() + " to " + texts.back() +
         " s: " + texts[0] + ", " + texts[1] + ", " + texts[2] + " ...";
}

double least_spacing(std::vector<double> times) {
  std::ranges::sort(times);
  double least = HUGE_VAL;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    if (times[i + 1] > times[i]) least = std::min(least, times[i + 1] - times[i]);
  }
  return least;
}

}  // namespace suffuse
