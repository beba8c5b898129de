#include "case/time_function.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

constexpr auto by_value = [](const auto& knot) { return knot.second; };

}  // namespace

double TimeFunction::value(double time) const {
  const auto after =
      std::ranges::upper_bound(knots, time, {}, [](const auto& knot) { return knot.first; });
  if (after == knots.begin()) return knots.front().second;
  if (after == knots.end()) return knots.back().second;
  const auto before = after - 1;
  return std::lerp(before->second, after->second,
                   (time - before->first) / (after->first - before->first));
}

bool TimeFunction::is_constant() const {
  return smallest() == largest();
}

double TimeFunction::smallest() const {
  return std::ranges::min(knots, {}, by_value).second;
}

double TimeFunction::largest() const {
  return std::ranges::max(knots, {}, by_value).second;
}

std::pair<double, double> TimeFunction::range(double begin, double end) const {
  auto [low, high] = std::minmax({value(begin), value(end)});
  for (const auto& [time, value] : knots) {
    if (time < begin || time > end) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return {low, high};
}

std::vector<double> TimeFunction::breakpoints() const {
  std::vector<double> times;
  for (const auto& [time, value] : knots) times.push_back(time);
  return times;
}

}  // namespace suffuse
