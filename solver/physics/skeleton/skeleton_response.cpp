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
Principal principal_strains(const Matrix3d& b) {
  if constexpr (Dim == 3) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(b);
    return {0.5 * solver.eigenvalues().array().log(), solver.eigenvectors()};
  }
  // In plane strain the third direction is known, and the others follow from an angle.
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

/// x / (exp(2 x) - 1), 1/2 at 0: x coth(x)/2 - x/2. The series of x coth(x) is exact to round-off
/// for elastic strains of most soils, and four times faster.
double share_of_rotation(double x) {
  const double square = x * x;
  if (square > 1e-3) return x / std::expm1(2.0 * x);
  const double series =
      1.0 + square * (1.0 / 3.0 + square * (-1.0 / 45.0 + square * (2.0 / 945.0)));
  return 0.5 * (series - x);
}

/// d tau / d g. In the principal directions of the trial state, with lambda = exp(2 epsilon):
/// d epsilon_a = g_aa, d tau_ab = (tau_a - tau_b)/(lambda_a - lambda_b) (lambda_b g_ab + lambda_a
/// g_ba). The secant of the law avoids cancellation for equal values.
template <int Dim>
DeformationTangent<Dim> tangent_of(const Principal& trial, const PrincipalResponse& response) {
  const Eigen::Matrix<double, Dim, Dim> directions = trial.directions.topLeftCorner<Dim, Dim>();
  DeformationTangent<Dim> principal = DeformationTangent<Dim>::Zero();
  DeformationTangent<Dim> axes;
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      const int ab = a + Dim * b;
      for (int c = 0; a == b && c < Dim; ++c) principal(ab, c + Dim * c) = response.tangent(a, c);
      if (a != b) {
        const double secant = response.shear_secant[3 - a - b];
        principal(ab, ab) = secant * share_of_rotation(trial.strain[a] - trial.strain[b]);
        principal(ab, b + Dim * a) = secant * share_of_rotation(trial.strain[b] - trial.strain[a]);
      }
      axes.col(ab) = (directions.col(a) * directions.col(b).transpose()).reshaped();
    }
  }
  return axes * principal * axes.transpose();
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
  if (tangent) *tangent = tangent_of<Dim>(trial, response);
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
