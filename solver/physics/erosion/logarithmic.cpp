/// Eq. 7 of the paper: phi_e = -beta ln(n_L / n_L,max). n_L approaches n_L,max asymptotically. A
/// residual lowers this limit.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

/// n_L,max minus the residual.
double porosity_max(const LocalState& state) {
  return state.porosity + state.erodible_fraction;
}

double deficit(const LocalState& state) {
  return -std::log(state.porosity / porosity_max(state));
}

/// Integrates dw/ds = -exp(exp(w)) with w = ln(-ln(n / n_max)) and s = S / n_max. The right-hand
/// side tends to a constant at late times, so n approaches n_max without overshoot. Classical
/// Runge-Kutta with steps that are short against the initial rate.
double after(const LocalState& state, double scaled_time) {
  constexpr double longest_step = 0.01;
  const double start = deficit(state);
  if (start <= 0.0) return state.porosity;
  const auto slope = [](double w) { return -std::exp(std::exp(w)); };
  double w = std::log(start);
  double remaining = scaled_time / porosity_max(state);
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
  return porosity_max(state) * std::exp(-std::exp(w));
}

/// -li(exp(-exp(w))) = E1(exp(w)), by its series if the fraction is 1 within rounding.
double minus_li(double w) {
  return w < -40.0 ? -std::numbers::egamma - w : -std::expint(-std::exp(w));
}

/// li(n / n_max) = li(n_0 / n_max) - S / n_max. In w the function is convex and falling, so
/// Newton's method from n_0, on the far side of the root, cannot fail.
double exact(const LocalState& state, double scaled_time) {
  double w = std::log(deficit(state));
  const double target = minus_li(w) + scaled_time / porosity_max(state);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double change = (minus_li(w) - target) / std::exp(-std::exp(w));
    w += change;
    if (std::abs(change) <= 1e-15 * std::max(1.0, std::abs(w))) break;
  }
  return porosity_max(state) * std::exp(-std::exp(w));
}

}  // namespace

extern const ErosionLaw logarithmic{.word = "logarithmic",
                                    .equation = "-ln(n_L / (n_L,max - residual))",
                                    .rate_symbol = "beta",
                                    .state = deficit,
                                    .porosity_after = after,
                                    .exact_porosity = exact};

}  // namespace suffuse::erosion
