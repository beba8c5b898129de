/// Conductivity is proportional to a power of the porosity.

#include <cmath>

#include "physics/conductivity/conductivity_law.hpp"

namespace suffuse::conductivity {
namespace {

constexpr ConductivityParameter exponent{.key = "exponent",
                                         .symbol = "m",
                                         .sentence = "Power of the porosity.",
                                         .value = &ConductivityParameters::exponent};

double ratio(const ConductivityModel& model, double initial_porosity, double porosity) {
  return std::pow(porosity / initial_porosity, model.parameters.exponent);
}

}  // namespace

extern const ConductivityLaw power{.word = "power",
                                   .description = "k = k_0 (n_L / n_0)^m, m being `exponent`",
                                   .parameters = {&exponent, 1},
                                   .ratio = ratio};

}  // namespace suffuse::conductivity
