/// The erodible fines decay exponentially in scaled time.

#include "physics/erosion/first_order.hpp"

#include <cmath>

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {

double first_order_state(const LocalState& state) {
  return state.erodible_fraction;
}

double porosity_after_first_order(const LocalState& state, double scaled_time) {
  return state.porosity - state.erodible_fraction * std::expm1(-scaled_time);
}

extern const ErosionLaw first_order{.word = "first-order",
                                    .equation = "n_e - residual",
                                    .rate_symbol = "kappa",
                                    .state = first_order_state,
                                    .porosity_after = porosity_after_first_order};

}  // namespace suffuse::erosion
