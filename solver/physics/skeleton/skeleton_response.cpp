#include "physics/skeleton/skeleton_response.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "physics/skeleton/elasticity.hpp"

namespace suffuse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Logarithmic strains and their directions, in columns.
struct Principal {
  Vector3d strain;
  Matrix3d directions;
};

template <int Dim>
Principal principal_strains(const Matrix3d& b);

template <>
Principal principal_strains<3>(const Matrix3d& b) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(b);
  return {0.5 * solver.eigenvalues().array().log(), solver.eigenvectors()};
}

/// In plane strain the third direction is known, and the others follow from an angle.
template <>
Principal principal_strains<2>(const Matrix3d& b) {
  const double half_difference = 0.5 * (b(0, 0) - b(1, 1));
  const double radius = std::hypot(half_difference, b(0, 1));
  const double larger = 0.5 * (b(0, 0) + b(1, 1)) + radius;
  // The mean minus the radius would cancel if one value is much smaller than the other.
  const double smaller = (b(0, 0) * b(1, 1) - b(0, 1) * b(0, 1)) / larger;
  const double angle = 0.5 * std::atan2(b(0, 1), half_difference);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Principal result;
  result.strain << 0.5 * std::log(larger), 0.5 * std::log(smaller), 0.5 * std::log(b(2, 2));
  result.directions << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return result;
}

Matrix3d tensor_of(const Principal& axes, const Vector3d& values) {
  return axes.directions * values.asDiagonal() * axes.directions.transpose();
}

/// x / (exp(2 x) - 1), 1/2 at 0.
double share_of_rotation(double x) {
  return x == 0.0 ? 0.5 : x / std::expm1(2.0 * x);
}

/// d P / d F of P = tau F^-T. With g = dF F^-1 in the principal directions of the trial state,
/// d epsilon_a = g_aa and d tau_ab = (tau_a - tau_b)/(lambda_a - lambda_b) (lambda_b g_ab +
/// lambda_a g_ba), where lambda = exp(2 epsilon). The secant of the law, and quotients of lambda
/// written with differences of strains, avoid cancellation for equal values.
template <int Dim>
DeformationTangent<Dim> deformation_tangent(const Principal& trial,
                                            const PrincipalResponse& response,
                                            const Matrix3d& stress,
                                            const Eigen::Matrix<double, Dim, Dim>& increment) {
  using Plane = Eigen::Matrix<double, Dim, Dim>;
  const Plane directions = trial.directions.topLeftCorner<Dim, Dim>();
  const Plane inverse = increment.inverse();
  const Plane moved = inverse * directions;
  const Plane first_stress = stress.topLeftCorner<Dim, Dim>() * inverse.transpose();  // P
  Plane weight;  // coefficient of g_ab in d tau_ab
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      const double secant = a == b ? 0.0 : response.shear_secant[3 - a - b];
      weight(a, b) = secant * share_of_rotation(trial.strain[a] - trial.strain[b]);
    }
  }
  DeformationTangent<Dim> tangent;
  for (int k = 0; k < Dim; ++k) {
    for (int l = 0; l < Dim; ++l) {
      const Plane g = directions.row(k).transpose() * moved.row(l);
      Plane change = weight.cwiseProduct(g);
      change += change.transpose().eval();
      change.diagonal() = response.tangent.topLeftCorner<Dim, Dim>() * g.diagonal();
      Plane column = directions * change * moved.transpose();
      column -= first_stress.col(l) * inverse.col(k).transpose();
      tangent.col(k + Dim * l) = column.reshaped();
    }
  }
  return tangent;
}

}  // namespace

template <int Dim>
SkeletonResponse skeleton_response(const SkeletonLaw& law, const SkeletonParameters& parameters,
                                   const SkeletonState& before,
                                   const Eigen::Matrix<double, Dim, Dim>& increment,
                                   DeformationTangent<Dim>* tangent) {
  SkeletonResponse result;
  result.state = before;
  Matrix3d& b = result.state.elastic_b;
  const Eigen::Matrix<double, Dim, Dim> turned =
      increment * before.elastic_b.topLeftCorner<Dim, Dim>() * increment.transpose();
  b.topLeftCorner<Dim, Dim>() = 0.5 * (turned + turned.transpose());
  const Principal trial = principal_strains<Dim>(b);
  const PrincipalResponse response = law.respond(parameters, trial.strain, before.internal);
  result.stress = tensor_of(trial, response.stress);
  result.plastic_strain = response.plastic_strain;
  result.state.internal += response.internal_change;
  if (response.plastic_strain > 0.0) {
    b = tensor_of(trial, (2.0 * response.elastic_strain.array()).exp());
  }
  if (tangent) *tangent = deformation_tangent<Dim>(trial, response, result.stress, increment);
  return result;
}

Matrix3d elastic_b_under(const SkeletonParameters& parameters, const Matrix3d& stress) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(stress);
  const Vector3d strain = skeleton::elastic_strain(parameters, solver.eigenvalues());
  return solver.eigenvectors() * (2.0 * strain.array()).exp().matrix().asDiagonal() *
         solver.eigenvectors().transpose();
}

template SkeletonResponse skeleton_response<2>(const SkeletonLaw&, const SkeletonParameters&,
                                               const SkeletonState&, const Eigen::Matrix2d&,
                                               DeformationTangent<2>*);
template SkeletonResponse skeleton_response<3>(const SkeletonLaw&, const SkeletonParameters&,
                                               const SkeletonState&, const Eigen::Matrix3d&,
                                               DeformationTangent<3>*);

}  // namespace suffuse
