/// Perfect plasticity at sqrt(J_2) = c with associated flow. The return mapping to the cylinder is
/// radial (Simo and Hughes, Computational Inelasticity (1998), 3.3).

#include <array>
#include <cmath>

#include "physics/skeleton/elasticity.hpp"

namespace suffuse::skeleton {
namespace {

PrincipalResponse respond(const SkeletonParameters& p, const Eigen::Vector3d& trial,
                          double /*internal*/) {
  PrincipalResponse response = elastic_response(p, trial);
  const double mean = trial.mean();
  const Eigen::Vector3d deviator = trial.array() - mean;
  const double length = deviator.norm();
  const double double_shear = 2.0 * p.shear_modulus();
  const double strength = std::sqrt(2.0) * p.cohesion;  // limit of the norm of the stress deviator
  // A stress on the surface within round-off does not yield.
  if (double_shear * length <= strength * (1.0 + 1e-12) + 1e-14 * p.young) return response;

  const double left = strength / (double_shear * length);  // remaining share of the deviator
  const Eigen::Vector3d direction = deviator / length;
  const double bulk = p.lame() + double_shear / 3.0;
  response.elastic_strain = mean + left * deviator.array();
  response.stress = 3.0 * bulk * mean + left * double_shear * deviator.array();
  response.plastic_strain = std::sqrt(2.0 / 3.0) * (1.0 - left) * length;
  response.tangent.setConstant(bulk - left * double_shear / 3.0);
  response.tangent.diagonal().array() += left * double_shear;
  response.tangent -= left * double_shear * direction * direction.transpose();
  response.shear_secant.setConstant(left * double_shear);
  return response;
}

constexpr std::array parameters{young, poisson, cohesion};

}  // namespace

extern const SkeletonLaw von_mises{.word = "von-mises",
                                   .description = "yields at sqrt(J_2) = c, keeps its volume then",
                                   .parameters = parameters,
                                   .respond = respond};

}  // namespace suffuse::skeleton
