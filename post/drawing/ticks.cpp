#include "drawing/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace suffuse {

bool is_one_value(double low, double high) {
  return !(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)));
}

std::vector<double> round_ticks(double low, double high) {
  if (is_one_value(low, high)) {
    const double room = std::max(std::abs(low), 1.0) * 0.05;
    low -= room;
    high += room;
  }
  const double rough = (high - low) / 8.0;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * decade >= rough) step = factor * decade;
  }
  // An end that lies on a tick up to rounding needs no tick beyond it.
  const auto first = static_cast<long>(std::floor(low / step + 1e-9));
  const auto last = static_cast<long>(std::ceil(high / step - 1e-9));
  std::vector<double> ticks;
  for (long k = first; k <= last; ++k) ticks.push_back(static_cast<double>(k) * step);
  return ticks;
}

std::string tick_text(double tick) {
  return digits_text(tick, 6);
}

std::string digits_text(double value, int digits) {
  char buffer[64];
  const double size = std::abs(value);
  if (size == 0.0 || (size >= 0.999e-3 && size < 1e6)) {
    // Whole numbers get more digits instead of an exponent.
    const bool is_whole = size >= std::pow(10.0, digits);
    std::snprintf(buffer, sizeof buffer, is_whole ? "%.*f" : "%.*g", is_whole ? 0 : digits, value);
    return buffer;
  }
  std::snprintf(buffer, sizeof buffer, "%.*e", digits - 1, value);
  std::string mantissa(buffer, std::find(buffer, buffer + sizeof buffer, 'e'));
  const std::string exponent(std::find(buffer, buffer + sizeof buffer, 'e'));
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  return mantissa + "e" + std::to_string(std::stoi(exponent.substr(1)));
}

LogarithmicTicks logarithmic_ticks(double low, double high) {
  constexpr std::array<double, 3> factors{1.0, 2.0, 5.0};
  // An end that lies on a tick up to rounding needs no tick beyond it.
  constexpr double slack = 1e-9;
  constexpr double three_decades = 1000.0;
  LogarithmicTicks found;
  std::vector<double> all;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int decade = first; decade <= last; ++decade) {
    for (const double factor : factors) all.push_back(factor * std::pow(10.0, decade));
  }
  found.low = *std::prev(std::ranges::upper_bound(all, low * (1.0 + slack)));
  const auto end = std::ranges::lower_bound(all, high * (1.0 - slack));
  found.high = end == all.end() ? all.back() : *end;
  if (found.high <= found.low) found.high = *std::ranges::upper_bound(all, found.low);
  const bool powers_only = found.high > three_decades * found.low * (1.0 + slack);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] < found.low || all[i] > found.high) continue;
    if (!powers_only || i % factors.size() == 0) found.ticks.push_back(all[i]);
  }
  return found;
}

std::string logarithmic_tick_text(double tick) {
  if (tick >= 0.999e-3 && tick < 1e4) return tick_text(tick);
  const int power = static_cast<int>(std::floor(std::log10(tick) + 1e-9));
  return tick_text(tick / std::pow(10.0, power)) + "e" + std::to_string(power);
}

}  // namespace suffuse
