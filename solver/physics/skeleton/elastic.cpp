/// Hencky's elasticity: it never yields.

#include <array>

#include "physics/skeleton/elasticity.hpp"

namespace suffuse::skeleton {
namespace {

PrincipalResponse respond(const SkeletonParameters& p, const Eigen::Vector3d& trial,
                          double /*internal*/) {
  return elastic_response(p, trial);
}

constexpr std::array parameters{young, poisson};

}  // namespace

extern const SkeletonLaw elastic{
    .word = "elastic",
    .description = "Kirchhoff stress linear in logarithmic strain, at any strain",
    .parameters = parameters,
    .respond = respond};

}  // namespace suffuse::skeleton
