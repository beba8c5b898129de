#pragma once

/// The tensors of a skeleton law: stress, elastic deformation and consistent tangent of an
/// increment of the deformation, for any law of principal values (Charlton, Coombs and Augarde,
/// Comput. Struct. 190 (2017) 108; de Souza Neto, Peric and Owen, Computational Methods for
/// Plasticity (2008), 14.5).

#include <Eigen/Core>

#include "physics/skeleton/skeleton_law.hpp"

namespace suffuse {

/// d P_iJ / d F_kL, Pa: row i + Dim J, column k + Dim L, so that vec(dP) = tangent vec(dF) with
/// Eigen's order of a matrix's entries.
template <int Dim>
using DeformationTangent = Eigen::Matrix<double, Dim * Dim, Dim * Dim>;

/// What a point keeps of its skeleton.
struct SkeletonState {
  /// Elastic left Cauchy-Green tensor, positive definite: the stress follows from it. In plane
  /// strain xz and yz are 0. It stays where fines are lost.
  Eigen::Matrix3d elastic_b = Eigen::Matrix3d::Identity();
  double internal = 0.0;  ///< the law's internal variable

  void archive(auto& archive) { archive(elastic_b, internal); }
};

/// The skeleton at a point after an increment. Volumes are those of the soil with its pores.
struct SkeletonResponse {
  /// Kirchhoff stress tau = (V/V_0) sigma', Pa, tension positive; sigma' is the effective stress.
  Eigen::Matrix3d stress;
  SkeletonState state;
  double plastic_strain = 0.0;  ///< increment of the equivalent plastic strain; 0: elastic
};

/// The response to an increment F of the deformation gradient, det F > 0.
/// \param before     in plane strain (Dim 2) xz and yz are not looked at
/// \param increment  F: places after over places before
/// \param tangent    of P = tau F^-T (its upper left Dim x Dim part), exact, where not null; it
///                   is symmetric where flow is associated
template <int Dim>
SkeletonResponse skeleton_response(const SkeletonLaw& law, const SkeletonParameters& parameters,
                                   const SkeletonState& before,
                                   const Eigen::Matrix<double, Dim, Dim>& increment,
                                   DeformationTangent<Dim>* tangent = nullptr);

/// The elastic left Cauchy-Green tensor under a Kirchhoff stress, Pa: a stress to start from. The
/// stress must be one that the law can carry, which is not checked.
Eigen::Matrix3d elastic_b_under(const SkeletonParameters& parameters,
                                const Eigen::Matrix3d& stress);

}  // namespace suffuse
