/// S_e and k_r fall exponentially with suction (Gardner, Soil Sci. 85 (1958) 228). The flow
/// equation becomes linear and has exact solutions.

#include <array>
#include <cmath>

#include "physics/retention/retention_law.hpp"

namespace suffuse::retention {
namespace {

double saturation(const RetentionParameters& p, double psi) {
  return std::exp(p.alpha * psi);
}

double capacity(const RetentionParameters& p, double psi) {
  return p.alpha * std::exp(p.alpha * psi);
}

double steepest(const RetentionParameters& p) {
  return -1e-6 / p.alpha;  // just below 0, where the capacity jumps to 0
}

constexpr std::array parameters{RetentionParameter{
    "alpha", "alpha", "1/m", "Reciprocal of the suction head at which the pores empty.", 0.0,
    &RetentionParameters::alpha}};

}  // namespace

extern const RetentionLaw gardner{.word = "gardner",
                                  .description = "S_e = k_r = exp(alpha psi)",
                                  .parameters = parameters,
                                  .saturation = saturation,
                                  .capacity = capacity,
                                  .steepest = steepest,
                                  .relative_conductivity = saturation};

}  // namespace suffuse::retention
