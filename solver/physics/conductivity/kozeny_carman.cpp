/// Conductivity goes with n^3 / (1 - n)^2 (Carman, Trans. Inst. Chem. Eng. 15 (1937) 150): infinite
/// where there is no solid.

#include "physics/conductivity/conductivity_law.hpp"

namespace suffuse::conductivity {
namespace {

double shape(double porosity) {
  const double solid = 1.0 - porosity;
  return porosity * porosity * porosity / (solid * solid);
}

double ratio(double initial_porosity, double porosity) {
  return shape(porosity) / shape(initial_porosity);
}

}  // namespace

extern const ConductivityLaw kozeny_carman{
    .word = "kozeny-carman",
    .description =
        "k = k_0 KC(n_L) / KC(n_0) with KC(n) = n^3 / (1 - n)^2, k_0 being `conductivity`",
    .ratio = ratio};

}  // namespace suffuse::conductivity
