/// Eq. 7 of the paper: phi_e = -beta ln(n_L / n_L,max), which nears n_L,max without end.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double rate(const ErosionModel& model, const LocalState& state) {
  return -model.rate * std::log(state.porosity / model.porosity_max);
}

/// In w = ln(-ln(n / n_max)): dw/ds = -exp(exp(w)), s = beta t / n_max. The right-hand side tends
/// to a constant as erosion runs out, so the approach to the cap is followed without end and
/// without overshoot. Classical Runge-Kutta with steps short against the initial rate.
double after(const ErosionModel& model, const LocalState& state, double duration) {
  constexpr double longest_step = 0.01;
  const double deficit = -std::log(state.porosity / model.porosity_max);
  if (deficit <= 0.0) return state.porosity;
  const auto slope = [](double w) { return -std::exp(std::exp(w)); };
  double w = std::log(deficit);
  double remaining = model.rate * duration / model.porosity_max;
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
  return model.porosity_max * std::exp(-std::exp(w));
}

/// -li(exp(-exp(w))) = E1(exp(w)), by its series where the fraction is one to rounding.
double minus_li(double w) {
  return w < -40.0 ? -std::numbers::egamma - w : -std::expint(-std::exp(w));
}

/// li(n / n_max) = li(n_0 / n_max) - beta t / n_max. In w the function is convex and falling, so
/// Newton's method from n_0, on the far side of the root, cannot fail.
double exact(const ErosionModel& model, const LocalState& state, double duration) {
  double w = std::log(-std::log(state.porosity / model.porosity_max));
  const double target = minus_li(w) + model.rate * duration / model.porosity_max;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double change = (minus_li(w) - target) / std::exp(-std::exp(w));
    w += change;
    if (std::abs(change) <= 1e-15 * std::max(1.0, std::abs(w))) break;
  }
  return model.porosity_max * std::exp(-std::exp(w));
}

}  // namespace

extern const ErosionLaw logarithmic{.word = "logarithmic",
                                    .equation = "phi_e = -beta ln(n_L / n_L,max)",
                                    .rate_symbol = "beta",
                                    .rate_unit = "1/s",
                                    .erosion_rate = rate,
                                    .porosity_after = after,
                                    .exact_porosity = exact};

}  // namespace suffuse::erosion
