#include "field/transport.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {

std::vector<TransportStep> equal_steps(double start, double end, double count) {
  std::vector<TransportStep> steps;
  double from = start;
  for (double s = 1.0; s <= count; ++s) {
    const double to = s == count ? end : start + (end - start) * s / count;
    steps.push_back({from, to, 1.0 / count});
    from = to;
  }
  return steps;
}

double step_count(double allowed) {
  constexpr double little = 0.01;
  return std::max(1.0, std::ceil((1.0 - little) / allowed));
}

}  // namespace suffuse
