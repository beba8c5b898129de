#include "exact_solution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace suffuse {
namespace {

/// -li(exp(-exp(w))) = E1(exp(w)), by its series where the fraction is one to rounding.
double minus_li(double w) {
  return w < -40.0 ? -std::numbers::egamma - w : -std::expint(-std::exp(w));
}

/// The x in (0, 1) where li(x) = li(start) - decrease. In w = ln(-ln x) the function is convex and
/// falling, so Newton's method from `start`, on the far side of the root, cannot fail.
double invert_li(double start, double decrease) {
  double w = std::log(-std::log(start));
  const double target = minus_li(w) + decrease;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double change = (minus_li(w) - target) / std::exp(-std::exp(w));
    w += change;
    if (std::abs(change) <= 1e-15 * std::max(1.0, std::abs(w))) break;
  }
  return std::exp(-std::exp(w));
}

}  // namespace

bool has_exact_porosity(const Soil& soil) {
  return soil.erosion.law != ErosionLaw::flux;
}

double exact_porosity(const Soil& soil, double initial, double t) {
  const double elapsed = t - soil.erosion.start;
  const double cap = soil.porosity_max();
  const double rate = soil.erosion.rate;
  if (elapsed <= 0.0 || initial >= cap) return initial;
  switch (soil.erosion.law) {
    case ErosionLaw::none:
      return initial;
    case ErosionLaw::constant:
      return std::min(cap, initial + rate * elapsed);
    case ErosionLaw::logarithmic:
      return cap * invert_li(initial / cap, rate * elapsed / cap);
    case ErosionLaw::first_order:
      return cap - (cap - initial) * std::exp(-rate * elapsed);
    case ErosionLaw::flux:
      return unset;
  }
  return unset;
}

double exhaustion_time(const Soil& soil, double initial) {
  const double fines = soil.porosity_max() - initial;
  if (fines <= 0.0) return soil.erosion.start;
  if (soil.erosion.law != ErosionLaw::constant || soil.erosion.rate == 0.0) {
    return std::numeric_limits<double>::infinity();
  }
  return soil.erosion.start + fines / soil.erosion.rate;
}

}  // namespace suffuse
