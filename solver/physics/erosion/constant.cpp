/// Eq. 6 of the paper: phi_e = alpha until nothing is left.

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double rate(const ErosionModel& model, const LocalState&) {
  return model.rate;
}

double after(const ErosionModel& model, const LocalState& state, double duration) {
  return state.porosity + model.rate * duration;
}

double exhaustion(const ErosionModel& model, double initial_porosity) {
  return (model.porosity_max - initial_porosity) / model.rate;
}

}  // namespace

extern const ErosionLaw constant{.word = "constant",
                                 .equation = "phi_e = alpha",
                                 .rate_symbol = "alpha",
                                 .rate_unit = "1/s",
                                 .erosion_rate = rate,
                                 .porosity_after = after,
                                 .exact_porosity = after,
                                 .exhaustion = exhaustion};

}  // namespace suffuse::erosion
