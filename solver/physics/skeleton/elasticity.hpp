#pragma once

/// Hencky's elasticity in principal values, and the keys of all laws: Kirchhoff stress is linear in
/// logarithmic strain (Hencky 1928; Charlton, Coombs and Augarde, Comput. Struct. 190 (2017) 108).

#include <Eigen/Core>
#include <limits>

#include "physics/skeleton/skeleton_law.hpp"

namespace suffuse::skeleton {

/// d tau_i / d epsilon_j, Pa
inline Eigen::Matrix3d elastic_matrix(const SkeletonParameters& p) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Constant(p.lame());
  matrix.diagonal().array() += 2.0 * p.shear_modulus();
  return matrix;
}

/// The response of a law that does not yield.
inline PrincipalResponse elastic_response(const SkeletonParameters& p,
                                          const Eigen::Vector3d& trial) {
  const double double_shear = 2.0 * p.shear_modulus();
  PrincipalResponse response;
  response.tangent = elastic_matrix(p);
  response.stress = double_shear * trial.array() + p.lame() * trial.sum();
  response.elastic_strain = trial;
  response.shear_secant.setConstant(double_shear);
  return response;
}

/// Logarithmic strains of principal Kirchhoff stresses, Pa.
inline Eigen::Vector3d elastic_strain(const SkeletonParameters& p, const Eigen::Vector3d& stress) {
  const double lateral = p.poisson * stress.sum();
  return ((1.0 + p.poisson) * stress.array() - lateral) / p.young;
}

inline constexpr SkeletonParameter young{.key = "young",
                                         .symbol = "E",
                                         .unit = "Pa",
                                         .sentence = "Young's modulus.",
                                         .lower = 0.0,
                                         .lower_allowed = false,
                                         .upper = std::numeric_limits<double>::infinity(),
                                         .follows_fines = true,
                                         .required = true,
                                         .value = &SkeletonModel::young};
inline constexpr SkeletonParameter poisson{.key = "poisson",
                                           .symbol = "nu",
                                           .unit = "",
                                           .sentence = "Poisson's ratio.",
                                           .lower = -1.0,
                                           .lower_allowed = false,
                                           .upper = 0.5,
                                           .follows_fines = false,
                                           .required = true,
                                           .value = &SkeletonModel::poisson};
inline constexpr SkeletonParameter friction{
    .key = "friction",
    .symbol = "phi",
    .unit = "degrees",
    .sentence = "Angle of friction, effective. 0: Tresca's law, undrained strength.",
    .lower = 0.0,
    .lower_allowed = true,
    .upper = 90.0,
    .follows_fines = true,
    .required = true,
    .value = &SkeletonModel::friction};
inline constexpr SkeletonParameter cohesion{
    .key = "cohesion",
    .symbol = "c",
    .unit = "Pa",
    .sentence = "Cohesion, effective: the shear strength without normal stress.",
    .lower = 0.0,
    .lower_allowed = true,
    .upper = std::numeric_limits<double>::infinity(),
    .follows_fines = true,
    .required = true,
    .value = &SkeletonModel::cohesion};
inline constexpr SkeletonParameter dilation{
    .key = "dilation",
    .symbol = "psi",
    .unit = "degrees",
    .sentence = "Angle of dilation, at most that of friction.",
    .lower = 0.0,
    .lower_allowed = true,
    .upper = 90.0,
    .follows_fines = false,
    .required = false,
    .value = &SkeletonModel::dilation};

}  // namespace suffuse::skeleton
