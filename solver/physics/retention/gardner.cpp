/// S_e and k_r fall exponentially with suction (Gardner, Soil Sci. 85 (1958) 228). The flow
/// equation becomes linear and has exact solutions.

#include <array>
#include <cmath>

#include "physics/retention/retention_law.hpp"

namespace suffuse::retention {
namespace {

RetentionState at(const RetentionParameters& p, double psi) {
  const double held = std::exp(p.alpha * psi);
  return {held, p.alpha * held, held, p.alpha * held};
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
                                  .at = at,
                                  .steepest = steepest};

}  // namespace suffuse::retention
