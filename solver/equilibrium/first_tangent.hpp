#pragma once

/// From the tangent of the Kirchhoff stress to that of the forces of an element.

#include "physics/skeleton/skeleton_response.hpp"

namespace suffuse {

/// d P / d F of P = tau F^-T: dP = (d tau - tau g^T) F^-T, g = dF F^-1. Symmetric for associated
/// flow.
/// \param of_stress  d tau / d g
/// \param stress     tau; `inverse`: F^-1
template <int Dim>
DeformationTangent<Dim> first_tangent(const DeformationTangent<Dim>& of_stress,
                                      const Eigen::Matrix<double, Dim, Dim>& stress,
                                      const Eigen::Matrix<double, Dim, Dim>& inverse) {
  DeformationTangent<Dim> tangent;
  for (int l = 0; l < Dim; ++l) {
    const Eigen::Matrix<double, Dim, 1> turned = stress * inverse.row(l).transpose();
    for (int k = 0; k < Dim; ++k) {
      // dF = e_k e_l^T
      Eigen::Matrix<double, Dim, Dim> change = Eigen::Matrix<double, Dim, Dim>::Zero();
      for (int m = 0; m < Dim; ++m) {
        change.reshaped() += inverse(l, m) * of_stress.col(k + Dim * m);
      }
      change.col(k) -= turned;
      tangent.col(k + Dim * l) = (change * inverse.transpose()).reshaped();
    }
  }
  return tangent;
}

}  // namespace suffuse
