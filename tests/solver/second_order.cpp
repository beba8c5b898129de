/// The last fines are the best sheltered: phi_e = nu (n_L,max - n_L)^2. The example of
/// docs/contributing.md.

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double rate(const ErosionModel& model, const LocalState& state) {
  return model.rate * state.erodible_fraction * state.erodible_fraction;
}

double after(const ErosionModel& model, const LocalState& state, double duration) {
  const double left = 1.0 / (1.0 + model.rate * state.erodible_fraction * duration);
  return state.porosity + state.erodible_fraction * (1.0 - left);
}

}  // namespace

extern const ErosionLaw second_order{.word = "second-order",
                                     .equation = "phi_e = nu (n_L,max - n_L)^2",
                                     .rate_symbol = "nu",
                                     .rate_unit = "1/s",
                                     .erosion_rate = rate,
                                     .porosity_after = after,
                                     .exact_porosity = after};

}  // namespace suffuse::erosion
