/// The last fines are the best sheltered: the state is n_e^2. The example of
/// docs/develop/contributing.md.

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double squared(const LocalState& state) {
  return state.erodible_fraction * state.erodible_fraction;
}

double after(const LocalState& state, double scaled_time) {
  const double left = 1.0 / (1.0 + state.erodible_fraction * scaled_time);
  return state.porosity + state.erodible_fraction * (1.0 - left);
}

}  // namespace

extern const ErosionLaw second_order{.word = "second-order",
                                     .equation = "(n_e - residual)^2",
                                     .rate_symbol = "nu",
                                     .state = squared,
                                     .porosity_after = after};

}  // namespace suffuse::erosion
