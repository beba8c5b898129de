/// Erosion goes with the flow beyond a threshold: phi_e = lambda (n_L,max - n_L) <|q| - q_cr>,
/// <x> = max(x, 0). What is left decays exponentially in the volume of liquid that has passed
/// beyond it. Exact for the mean of |q| over a step, as long as |q| does not cross the threshold
/// within.

#include <algorithm>
#include <cmath>

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

/// <|q| - q_cr>, m/s; not a number where |q| is none.
double drive(const ErosionModel& model, const LocalState& state) {
  return std::max(state.flux - model.parameters.threshold, 0.0);
}

double rate(const ErosionModel& model, const LocalState& state) {
  return model.rate * drive(model, state) * state.erodible_fraction;
}

double after(const ErosionModel& model, const LocalState& state, double duration) {
  const double decay = model.rate * drive(model, state) * duration;
  return state.porosity - state.erodible_fraction * std::expm1(-decay);
}

constexpr ErosionParameter threshold{.key = "threshold",
                                     .symbol = "q_cr",
                                     .unit = "m/s",
                                     .sentence = "Flux below which nothing erodes.",
                                     .value = &ErosionParameters::threshold};

}  // namespace

extern const ErosionLaw flux{.word = "flux",
                             .equation = "phi_e = lambda (n_L,max - n_L) max(|q| - q_cr, 0)",
                             .rate_symbol = "lambda",
                             .rate_unit = "1/m",
                             .parameters = {&threshold, 1},
                             .depends_on_flux = true,
                             .erosion_rate = rate,
                             .porosity_after = after,
                             .exact_porosity = after};

}  // namespace suffuse::erosion
