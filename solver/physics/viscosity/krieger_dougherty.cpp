/// A suspension of hard spheres: mu = mu_0 (1 - c/c_m)^(-2.5 c_m) (Krieger and Dougherty, Trans.
/// Soc. Rheol. 3 (1959) 137), which tends to Einstein's 1 + 2.5 c for small c.

#include <cmath>

#include "physics/viscosity/viscosity_law.hpp"

namespace suffuse::viscosity {
namespace {

double ratio(double concentration, double maximum) {
  return std::pow(1.0 - concentration / maximum, -2.5 * maximum);
}

}  // namespace

extern const ViscosityLaw krieger_dougherty{
    .word = "krieger-dougherty",
    .description = "mu = mu_0 (1 - c/c_m)^(-2.5 c_m), c_m being `maximum_concentration`",
    .ratio = ratio};

}  // namespace suffuse::viscosity
