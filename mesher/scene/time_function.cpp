#include "scene/time_function.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

constexpr auto by_value = [](const auto& knot) { return knot.second; };

double between(double before, double after, double share) {
  return std::lerp(before, after, share);
}

VectorFunction::Components between(const VectorFunction::Components& before,
                                   const VectorFunction::Components& after, double share) {
  VectorFunction::Components result{};
  for (std::size_t d = 0; d < result.size(); ++d) result[d] = std::lerp(before[d], after[d], share);
  return result;
}

template <class Value>
Value interpolated(const std::vector<std::pair<double, Value>>& knots, double time) {
  const auto after =
      std::ranges::upper_bound(knots, time, {}, [](const auto& knot) { return knot.first; });
  if (after == knots.begin()) return knots.front().second;
  if (after == knots.end()) return knots.back().second;
  const auto before = after - 1;
  return between(before->second, after->second,
                 (time - before->first) / (after->first - before->first));
}

template <class Value>
std::vector<double> times_of(const std::vector<std::pair<double, Value>>& knots) {
  std::vector<double> times;
  times.reserve(knots.size());
  for (const auto& [time, value] : knots) times.push_back(time);
  return times;
}

}  // namespace

double TimeFunction::value(double time) const {
  return interpolated(knots, time);
}

double TimeFunction::slope(double time) const {
  const auto after =
      std::ranges::upper_bound(knots, time, {}, [](const auto& knot) { return knot.first; });
  if (after == knots.begin() || after == knots.end()) return 0.0;
  const auto before = after - 1;
  return (after->second - before->second) / (after->first - before->first);
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
  return times_of(knots);
}

VectorFunction::Components VectorFunction::value(double time) const {
  return interpolated(knots, time);
}

std::vector<double> VectorFunction::breakpoints() const {
  return times_of(knots);
}

}  // namespace suffuse
