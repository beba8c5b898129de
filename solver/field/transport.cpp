#include "field/transport.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/errors.hpp"

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

double step_count(double allowed, double start, double end, const StepCountLimit& limit) {
  constexpr double little = 0.01;
  const double count = std::max(1.0, std::ceil((1.0 - little) / allowed));
  if (allowed > 0.0 && count <= limit.most) return count;
  std::ostringstream message;
  message << "t = " << start << " s: transport takes more than " << limit.most << " steps to "
          << end << " s; " << limit.advice;
  throw NumericalError(message.str());
}

}  // namespace suffuse
