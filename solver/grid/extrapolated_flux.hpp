#pragma once

/// How fast liquid will go through faces in the time to come, for soils that erode by it.

#include <algorithm>
#include <vector>

namespace suffuse {

/// Volumes through faces per second over the last interval: its mean, and at its end. Both along
/// each face's normal, m3/s.
struct FluxHistory {
  std::vector<double> mean;
  std::vector<double> end;
  double duration = 1.0;  ///< of the interval, s

  void archive(auto& archive) { archive(mean, end, duration); }

  /// Mean rates over the next `ahead` seconds: those at the end go on changing as they did since
  /// the interval's mean. Over no more than a few times its duration: the interval tells nothing of
  /// what comes later.
  [[nodiscard]] std::vector<double> extrapolated(double ahead) const {
    constexpr double max_durations = 4.0;
    const double share = std::min(ahead / duration, max_durations);
    std::vector<double> result(end.size());
    for (std::size_t f = 0; f < end.size(); ++f) result[f] = end[f] + share * (end[f] - mean[f]);
    return result;
  }
};

}  // namespace suffuse
