#include "physics/erosion_law.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

/// Eq. 7 in w = ln(-ln(n / n_max)): dw/ds = -exp(exp(w)), s = beta t / n_max. The right-hand side
/// tends to a constant as erosion runs out, so the approach to the cap is followed without end and
/// without overshoot. Classical Runge-Kutta with steps short against the initial rate.
double logarithmic_porosity_after(double porosity, double porosity_max, double scaled_time) {
  constexpr double longest_step = 0.01;
  const double deficit = -std::log(porosity / porosity_max);
  if (deficit <= 0.0) return porosity;
  const auto slope = [](double w) { return -std::exp(std::exp(w)); };
  double w = std::log(deficit);
  double remaining = scaled_time;
  while (remaining > 0.0) {
    // Once the deficit is below round-off the slope is constant and one step is exact.
    const bool exhausted = w < -40.0;
    const double h = exhausted ? remaining : std::min(remaining, longest_step / -slope(w));
    const double k1 = slope(w);
    const double k2 = slope(w + 0.5 * h * k1);
    const double k3 = slope(w + 0.5 * h * k2);
    const double k4 = slope(w + h * k3);
    w += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    remaining -= h;
  }
  return std::max(porosity, porosity_max * std::exp(-std::exp(w)));
}

/// n_max - n decays by exp(-scaled_time).
double first_order_porosity_after(double porosity, double porosity_max, double scaled_time) {
  return std::min(porosity_max, porosity - (porosity_max - porosity) * std::expm1(-scaled_time));
}

}  // namespace

double erosion_rate(const ErosionModel& model, double porosity, double time, double flux) {
  if (time < model.start || porosity >= model.porosity_max) return 0.0;
  switch (model.law) {
    case ErosionLaw::none:
      return 0.0;
    case ErosionLaw::constant:
      return model.rate;
    case ErosionLaw::logarithmic:
      return -model.rate * std::log(porosity / model.porosity_max);
    case ErosionLaw::first_order:
      return model.rate * (model.porosity_max - porosity);
    case ErosionLaw::flux:
      return model.rate * flux * (model.porosity_max - porosity);
  }
  return unset;
}

double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                      double flux) {
  const double duration = to - std::max(from, model.start);
  if (duration <= 0.0 || porosity >= model.porosity_max) return porosity;
  switch (model.law) {
    case ErosionLaw::none:
      return porosity;
    case ErosionLaw::constant:
      return std::min(model.porosity_max, porosity + model.rate * duration);
    case ErosionLaw::logarithmic:
      return logarithmic_porosity_after(porosity, model.porosity_max,
                                        model.rate * duration / model.porosity_max);
    case ErosionLaw::first_order:
      return first_order_porosity_after(porosity, model.porosity_max, model.rate * duration);
    case ErosionLaw::flux:
      return first_order_porosity_after(porosity, model.porosity_max, model.rate * flux * duration);
  }
  return unset;
}

}  // namespace suffuse
