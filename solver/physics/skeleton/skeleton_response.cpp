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
  const double shear = b(0, 1);
  const double radius = std::sqrt(half_difference * half_difference + shear * shear);
  const double larger = 0.5 * (b(0, 0) + b(1, 1)) + radius;
  // The mean minus the radius would cancel if one value is much smaller than the other.
  const double smaller = (b(0, 0) * b(1, 1) - shear * shear) / larger;
  Eigen::Vector2d axis(radius > 0.0 ? radius + std::abs(half_difference) : 1.0, std::abs(shear));
  axis.normalize();
  const double c = axis[half_difference < 0.0 ? 1 : 0];
  const double s = std::copysign(axis[half_difference < 0.0 ? 0 : 1], shear);
  return {0.5 * Vector3d(larger, smaller, b(2, 2)).array().log(),
          Matrix3d{{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}}};
}

template <int Dim>
Matrix3d tensor_of(const Principal& axes, const Vector3d& values) {
  const auto directions = axes.directions.topLeftCorner<Dim, Dim>();
  Matrix3d result = values.asDiagonal();
  result.topLeftCorner<Dim, Dim>() =
      directions * values.head<Dim>().asDiagonal() * directions.transpose();
  return result;
}

/// x / (exp(2 x) - 1), 1/2 at 0.
double share_of_rotation(double x) {
  return x == 0.0 ? 0.5 : x / std::expm1(2.0 * x);
}

/// d P / d F of P = tau F^-T. With g = dF F^-1 in the principal directions of the trial state and
/// lambda = exp(2 epsilon): d epsilon_a = g_aa, d tau_ab = (tau_a - tau_b)/(lambda_a - lambda_b)
/// (lambda_b g_ab + lambda_a g_ba). The secant of the law avoids cancellation for equal values.
template <int Dim>
DeformationTangent<Dim> tangent_of(const Principal& trial, const PrincipalResponse& response,
                                   const Matrix3d& stress,
                                   const Eigen::Matrix<double, Dim, Dim>& increment) {
  using Plane = Eigen::Matrix<double, Dim, Dim>;
  const Plane directions = trial.directions.topLeftCorner<Dim, Dim>();
  const Plane inverse = increment.inverse();
  const Plane moved = inverse * directions;
  const Plane first_stress = stress.topLeftCorner<Dim, Dim>() * inverse.transpose();  // P
  DeformationTangent<Dim> principal = DeformationTangent<Dim>::Zero();                // d tau / d g
  DeformationTangent<Dim> to_principal;  // its transpose is d g / d F
  DeformationTangent<Dim> tangent;
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      const int ab = a + Dim * b;
      for (int c = 0; a == b && c < Dim; ++c) principal(ab, c + Dim * c) = response.tangent(a, c);
      if (a != b) {
        const double secant = response.shear_secant[3 - a - b];
        principal(ab, ab) = secant * share_of_rotation(trial.strain[a] - trial.strain[b]);
        principal(ab, b + Dim * a) = secant * share_of_rotation(trial.strain[b] - trial.strain[a]);
      }
      to_principal.col(ab) = (directions.col(a) * moved.col(b).transpose()).reshaped();
      tangent.col(ab) = -(first_stress.col(b) * inverse.col(a).transpose()).reshaped();
    }
  }
  return tangent + to_principal * principal * to_principal.transpose();
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
  result.stress = tensor_of<Dim>(trial, response.stress);
  result.plastic_strain = response.plastic_strain;
  result.state.internal += response.internal_change;
  if (response.plastic_strain > 0.0) {
    b = tensor_of<Dim>(trial, (2.0 * response.elastic_strain.array()).exp());
  }
  if (tangent) *tangent = tangent_of<Dim>(trial, response, result.stress, increment);
  return result;
}

Matrix3d elastic_b_under(const SkeletonParameters& parameters, const Matrix3d& stress) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(stress);
  const Vector3d strain = skeleton::elastic_strain(parameters, solver.eigenvalues());
  return tensor_of<3>({strain, solver.eigenvectors()}, (2.0 * strain.array()).exp());
}

template SkeletonResponse skeleton_response<2>(const SkeletonLaw&, const SkeletonParameters&,
                                               const SkeletonState&, const Eigen::Matrix2d&,
                                               DeformationTangent<2>*);
template SkeletonResponse skeleton_response<3>(const SkeletonLaw&, const SkeletonParameters&,
                                               const SkeletonState&, const Eigen::Matrix3d&,
                                               DeformationTangent<3>*);

}  // namespace suffuse
