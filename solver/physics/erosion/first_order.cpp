/// What is left decays exponentially: phi_e = kappa (n_L,max - n_L).

#include <cmath>

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double rate(const ErosionModel& model, const LocalState& state) {
  return model.rate * state.erodible_fraction;
}

double after(const ErosionModel& model, const LocalState& state, double duration) {
  return state.porosity - state.erodible_fraction * std::expm1(-model.rate * duration);
}

}  // namespace

extern const ErosionLaw first_order{.word = "first-order",
                                    .equation = "phi_e = kappa (n_L,max - n_L)",
                                    .rate_symbol = "kappa",
                                    .rate_unit = "1/s",
                                    .erosion_rate = rate,
                                    .porosity_after = after,
                                    .exact_porosity = after};

}  // namespace suffuse::erosion
