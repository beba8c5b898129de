/// Hencky's elasticity: it never yields.

#include <array>

#include "physics/skeleton/elasticity.hpp"

namespace suffuse::skeleton {
namespace {

constexpr std::array parameters{young, poisson};

}  // namespace

extern const SkeletonLaw elastic{
    .word = "elastic",
    .description = "Kirchhoff stress linear in logarithmic strain, at any strain",
    .parameters = parameters,
    .respond = elastic_response};

}  // namespace suffuse::skeleton
