#include "motion/element_gains.hpp"

#include <algorithm>
#include <cstddef>

namespace suffuse {

std::vector<double> element_gains(const GainInput& in) {
  /// A negative solid volume within this share of an element's volume is round-off.
  constexpr double round_off = 1e-12;
  const std::size_t count = in.solid.size();
  std::vector<double> kept(in.piece_count, std::max(0.0, 1.0 - in.travel));
  for (std::size_t e = 0; e < count; ++e) {
    if (in.piece[e] < 0) continue;
    double& share = kept[in.piece[e]];
    const double difference = in.solid[e] - in.smooth_before[e];
    const bool is_less = in.smooth_after[e] + share * difference < -round_off * in.volume[e];
    if (is_less && difference < 0.0) share = std::max(0.0, in.smooth_after[e] / -difference);
  }
  std::vector<double> gain(count, 0.0);
  std::vector<double> sum(in.piece_count, 0.0);
  std::vector<double> solid(in.piece_count, 0.0);
  for (std::size_t e = 0; e < count; ++e) {
    if (in.piece[e] < 0) continue;
    const double difference = in.solid[e] - in.smooth_before[e];
    gain[e] = in.smooth_after[e] - in.smooth_before[e] - (1.0 - kept[in.piece[e]]) * difference;
    sum[in.piece[e]] += gain[e];
    solid[in.piece[e]] += in.solid[e] + gain[e];
  }
  // Distribute the rest, round-off or a difference between pieces that have merged, by the solid
  // that there is: an empty element stays empty.
  for (std::size_t e = 0; e < count; ++e) {
    const int piece = in.piece[e];
    if (piece < 0 || solid[piece] <= 0.0) continue;
    gain[e] -= sum[piece] * (in.solid[e] + gain[e]) / solid[piece];
  }
  return gain;
}

}  // namespace suffuse
