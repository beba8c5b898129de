#pragma once

/// The tensors of a skeleton law: stress, elastic deformation and consistent tangent of an
/// increment of the deformation, for any law of principal values (Charlton, Coombs and Augarde,
/// Comput. Struct. 190 (2017) 108; de Souza Neto, Peric and Owen, Computational Methods for
/// Plasticity (2008), 14.5).

#include <Eigen/Core>

#include "physics/skeleton/skeleton_law.hpp"

namespace suffuse {

/// d A_ij / d B_kl: row i + Dim j, column k + Dim l, so that vec(dA) = tangent vec(dB) with Eigen's
/// order of a matrix's entries.
template <int Dim>
using DeformationTangent = Eigen::Matrix<double, Dim * Dim, Dim * Dim>;

/// State of the skeleton at a point.
struct SkeletonState {
  /// Elastic left Cauchy-Green tensor, positive definite; the stress is a function of it. In plane
  /// strain xz and yz are 0. Loss of fines does not change it.
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
/// \param before     in plane strain (Dim 2) xz and yz are not used
/// \param increment  F: d(position after) / d(position before)
/// \param tangent    d tau / d g, Pa, of the upper left Dim x Dim parts, g = dF F^-1; exact; may be
///                   null
template <int Dim>
SkeletonResponse skeleton_response(const SkeletonLaw& law, const SkeletonParameters& parameters,
                                   const SkeletonState& before,
                                   const Eigen::Matrix<double, Dim, Dim>& increment,
                                   DeformationTangent<Dim>* tangent = nullptr);

/// The elastic left Cauchy-Green tensor for an initial Kirchhoff stress, Pa. The stress must be
/// admissible for the law, which is not checked.
Eigen::Matrix3d elastic_b_under(const SkeletonParameters& parameters,
                                const Eigen::Matrix3d& stress);

}  // namespace suffuse
