#include "stress/known_porosity.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse::stress {
namespace {

/// Simpson's rule for the integral of exp(-exp(w)).
double integral(double low, double high, int parts) {
  const double h = (high - low) / parts;
  double sum = 0.0;
  for (int i = 0; i <= parts; ++i) {
    const double weight = i == 0 || i == parts ? 1.0 : (i % 2 == 0 ? 2.0 : 4.0);
    sum += weight * std::exp(-std::exp(low + h * i));
  }
  return sum * h / 3.0;
}

/// Bisection for the porosity by the time that it takes, int dn / -ln(n), with n over its largest
/// value. With n = exp(-exp(w)) this is the integral of exp(-exp(w)) dw, smooth enough for
/// Simpson's rule.
double logarithmic(double first, double most, double scaled_time) {
  const double begin = std::log(-std::log(first / most));
  const auto time_to = [&](double end) {
    // Below this value the integrand is 1 up to round-off.
    constexpr double flat = -40.0;
    constexpr int parts = 4000;
    if (end < flat && begin > flat) return (flat - end) + integral(flat, begin, parts);
    return integral(end, begin, parts);
  };
  double low = begin - scaled_time * most / first - 1.0;
  double high = begin;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (time_to(middle) > scaled_time ? low : high) = middle;
  }
  return most * std::exp(-std::exp(high));
}

/// Whether some fines stay. A scene without a residual has 0.
bool has_residual(const ErosionModel& model) {
  return std::ranges::any_of(model.residual.pairs,
                             [](const auto& pair) { return pair.second > 0.0; });
}

}  // namespace

KnownPorosity::KnownPorosity(const Scene& scene) {
  for (const Soil& soil : scene.soils) {
    if (!soil.exchanges()) continue;
    const ErosionModel model = soil.erosion_model();
    if (soil_ != nullptr || soil.porosity_gradient != std::array<double, 3>{} ||
        soil.deposition.deposits() || depends_on_flux(model) || depends_on_concentration(model) ||
        has_residual(model) || soil.erosion.empty_elements == EmptyElements::dry) {
      soil_ = nullptr;
      return;
    }
    soil_ = &soil;
  }
}

double KnownPorosity::at(double t) const {
  const double duration = std::max(0.0, t - soil_->erosion.start);
  const double first = soil_->porosity;
  const double most = soil_->porosity_max();
  const double rate = soil_->erosion.rate;
  if (soil_->erosion.law == erosion_law("constant")) return std::min(most, first + rate * duration);
  if (soil_->erosion.law == erosion_law("first-order")) {
    return most - (most - first) * std::exp(-rate * duration);
  }
  return logarithmic(first, most, rate * duration / most);
}

}  // namespace suffuse::stress
