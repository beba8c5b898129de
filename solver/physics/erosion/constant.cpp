/// Eq. 6 of the paper: phi_e = alpha until all fines are eroded.

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double one(const LocalState&) {
  return 1.0;
}

double after(const LocalState& state, double scaled_time) {
  return state.porosity + scaled_time;
}

double exhaustion(const LocalState& state) {
  return state.erodible_fraction;
}

}  // namespace

extern const ErosionLaw constant{.word = "constant",
                                 .equation = "1",
                                 .rate_symbol = "alpha",
                                 .state = one,
                                 .porosity_after = after,
                                 .exhaustion = exhaustion};

}  // namespace suffuse::erosion
