#pragma once

/// How fast liquid will go through faces, for soils that erode by it.

#include <algorithm>
#include <vector>

namespace suffuse {

/// Mean rates over the next `ahead` seconds, per face, m3/s: those at the `end` of an interval of
/// `duration` seconds go on changing as they did since its `mean`. Over no more than a few times
/// that duration: it tells nothing of what comes later.
inline std::vector<double> mean_rate_ahead(const std::vector<double>& mean,
                                           const std::vector<double>& end, double duration,
                                           double ahead) {
  constexpr double most = 4.0;
  const double share = std::min(ahead / duration, most);
  std::vector<double> result(end.size());
  for (std::size_t f = 0; f < end.size(); ++f) result[f] = end[f] + share * (end[f] - mean[f]);
  return result;
}

}  // namespace suffuse
