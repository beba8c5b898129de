#include "driver/time_left.hpp"

#include <algorithm>

namespace suffuse {
namespace {

/// Two guesses that differ by less than this factor agree.
constexpr double agreement = 2.0;
/// Shorter stretches of wall time may be those of a single step, s.
constexpr double shortest_stretch = 0.1;

}  // namespace

std::optional<double> TimeLeft::at(double elapsed, double time) {
  std::optional<double> total;
  if (time > middle_.time && elapsed - middle_.elapsed >= shortest_stretch) {
    const double pace = (elapsed - middle_.elapsed) / (time - middle_.time);
    total = elapsed + pace * std::max(0.0, end_ - time);
  }
  const std::optional<double> before = middle_.total;
  const bool agrees =
      total && before && *total < agreement * *before && *before < agreement * *total;
  if (elapsed >= std::max(shortest_stretch, 2.0 * latest_.elapsed)) {
    middle_ = latest_;
    latest_ = {elapsed, time, total};
  }
  return agrees ? std::optional(*total - elapsed) : std::nullopt;
}

}  // namespace suffuse
