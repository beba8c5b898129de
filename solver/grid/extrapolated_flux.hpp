#pragma once

/// Extrapolates fluxes through faces from the last interval to later times, for soils whose erosion
/// depends on the flux.

#include <algorithm>
#include <vector>

namespace suffuse {

/// Volumes through faces per second in the last interval, along each face's normal, m3/s: mean, and
/// at its end.
struct FluxHistory {
  std::vector<double> mean;
  std::vector<double> end;
  double duration = 1.0;  ///< of the interval, s

  /// Mean rates over the next `ahead` seconds: linear through the interval's mean and end, but for
  /// at most a few times its duration.
  [[nodiscard]] std::vector<double> extrapolated(double ahead) const {
    constexpr double max_durations = 4.0;
    const double share = std::min(ahead / duration, max_durations);
    std::vector<double> result(end.size());
    for (std::size_t f = 0; f < end.size(); ++f) result[f] = end[f] + share * (end[f] - mean[f]);
    return result;
  }
};

}  // namespace suffuse
