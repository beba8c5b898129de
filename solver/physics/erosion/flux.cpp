/// Erosion goes with the flow: phi_e = lambda (n_L,max - n_L) |q|. What is left decays
/// exponentially in the volume of liquid that has passed; exact for the mean of |q| over a step.

#include <cmath>

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double rate(const ErosionModel& model, const LocalState& state) {
  return model.rate * state.flux * state.erodible_fraction;
}

double after(const ErosionModel& model, const LocalState& state, double duration) {
  const double decay = model.rate * state.flux * duration;
  return state.porosity - state.erodible_fraction * std::expm1(-decay);
}

}  // namespace

extern const ErosionLaw flux{.word = "flux",
                             .equation = "phi_e = lambda (n_L,max - n_L) |q|",
                             .rate_symbol = "lambda",
                             .rate_unit = "1/m",
                             .depends_on_flux = true,
                             .erosion_rate = rate,
                             .porosity_after = after,
                             .exact_porosity = after};

}  // namespace suffuse::erosion
