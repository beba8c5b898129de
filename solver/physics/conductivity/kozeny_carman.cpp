/// Conductivity is proportional to n^3 over the square of the surface of the grains (Carman, Trans.
/// Inst. Chem. Eng. 15 (1937) 150); without solid it is infinite. Per volume, fines have
/// `size_ratio` times the surface of coarse grains.

#include "physics/conductivity/conductivity_law.hpp"

namespace suffuse::conductivity {
namespace {

constexpr ConductivityParameter size_ratio{
    .key = "size_ratio",
    .symbol = "r",
    .sentence = "Mean size of the coarse grains over that of the fines, at least 1.",
    .value = &ConductivityParameters::size_ratio};

double shape(const ConductivityModel& model, double porosity) {
  // The surface is n_C + r n_e. With n_C + n_e = 1 - n it has no cancellation at r = 1.
  const double solid = 1.0 - porosity;
  const double excess = model.parameters.size_ratio - 1.0;
  const double surface = excess == 0.0 ? solid : solid + excess * (solid - model.skeleton_fraction);
  return porosity * porosity * porosity / (surface * surface);
}

double ratio(const ConductivityModel& model, double initial_porosity, double porosity) {
  return shape(model, porosity) / shape(model, initial_porosity);
}

}  // namespace

extern const ConductivityLaw kozeny_carman{
    .word = "kozeny-carman",
    .description =
        "k = k_0 KC(n_L) / KC(n_0) with KC(n_L) = n_L^3 / (n_C + r n_e)^2, k_0 being "
        "`conductivity` and r `size_ratio`",
    .parameters = {&size_ratio, 1},
    .ratio = ratio};

}  // namespace suffuse::conductivity
