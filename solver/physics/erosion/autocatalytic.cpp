/// Fluidised grains detach others: phi_e is proportional to n_e c (Vardoulakis, Stavropoulou and
/// Papanastasiou, Transp. Porous Media 22 (1996) 225).

#include "physics/erosion/erosion_law.hpp"

namespace suffuse::erosion {
namespace {

double state_factor(const LocalState& state) {
  return state.erodible_fraction * state.concentration;
}

}  // namespace

extern const ErosionLaw autocatalytic{.word = "autocatalytic",
                                      .equation = "(n_e - residual) c",
                                      .rate_symbol = "lambda_c",
                                      .depends_on_concentration = true,
                                      .state = state_factor};

}  // namespace suffuse::erosion
