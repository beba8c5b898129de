#pragma once

/// Small operations on times, and on values per element or per face.

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace suffuse {

/// Whether two times are equal up to the round-off of sums of steps.
inline bool is_same_time(double a, double b) {
  return std::abs(a - b) <= 1e-14 * std::max(std::abs(a), std::abs(b));
}

/// Whether `times` contain this time up to that round-off.
inline bool contains_time(const std::vector<double>& times, double time) {
  return std::ranges::any_of(times, [&](double other) { return is_same_time(other, time); });
}

/// The values at a share of the way from `a` to `b`; both have the same length.
template <class Value>
std::vector<Value> between(const std::vector<Value>& a, const std::vector<Value>& b, double share) {
  std::vector<Value> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] + share * (b[i] - a[i]);
  return result;
}

/// The largest magnitude; zero where there are no values.
inline double largest_magnitude(const std::vector<double>& values) {
  double result = 0.0;
  for (const double v : values) result = std::max(result, std::abs(v));
  return result;
}

inline double sum_of_magnitudes(std::span<const double> values) {
  double result = 0.0;
  for (const double v : values) result += std::abs(v);
  return result;
}

/// The largest |a_i - b_i|; both have the same length.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, std::abs(a[i] - b[i]));
  return result;
}

}  // namespace suffuse
