#include "physics/skeleton/soil_element.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

namespace suffuse {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr int most_iterations = 30;
constexpr int most_halvings = 5;  ///< per iteration of Newton's method
/// Smallest step, as a share of the way to a target. Strength is found to this accuracy.
constexpr double smallest_share = 1.0 / 16384.0;

Matrix3d tensor_of(const PlaneComponents& c) {
  Matrix3d tensor = c.head<3>().asDiagonal();
  tensor(0, 1) = tensor(1, 0) = c[3];
  return tensor;
}

PlaneComponents components_of(const Matrix3d& tensor) {
  return {tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1)};
}

/// A stretch without rotation, F = exp(H), with its derivative by H.
class Stretch {
 public:
  explicit Stretch(const PlaneComponents& strain) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(tensor_of(strain));
    logarithms_ = solver.eigenvalues();
    directions_ = solver.eigenvectors();
  }

  /// F, or its inverse with `sign` -1.
  [[nodiscard]] Matrix3d tensor(double sign = 1.0) const {
    const Vector3d stretches = (sign * logarithms_.array()).exp();
    return directions_ * stretches.asDiagonal() * directions_.transpose();
  }

  /// dF for a given dH (Daleckii and Krein).
  [[nodiscard]] Matrix3d change(const Matrix3d& strain_change) const {
    Matrix3d result = directions_.transpose() * strain_change * directions_;
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const double d = logarithms_[a] - logarithms_[b];
        result(a, b) *= std::exp(logarithms_[b]) * (d == 0.0 ? 1.0 : std::expm1(d) / d);
      }
    }
    return directions_ * result * directions_.transpose();
  }

 private:
  Vector3d logarithms_;
  Matrix3d directions_;
};

/// The state at a strain, reached in one increment, with d stress / d strain.
SoilElementState state_at(const SkeletonModel& model, const SoilElementState& before,
                          const PlaneComponents& strain, double fines_left, Matrix4d& tangent) {
  const Stretch stretch(strain);
  const Matrix3d before_inverse = Stretch(before.strain).tensor(-1.0);
  const Matrix3d increment = stretch.tensor() * before_inverse;
  DeformationTangent<3> of_gradient;
  const SkeletonResponse response = skeleton_response<3>(*model.law, model.at(fines_left),
                                                         before.skeleton, increment, &of_gradient);
  const double volume = std::exp(strain.head<3>().sum());
  SoilElementState state{.strain = strain,
                         .stress = components_of(response.stress) / volume,
                         .skeleton = response.state,
                         .plastic_strain = before.plastic_strain + response.plastic_strain,
                         .fines_left = fines_left};
  const Matrix3d inverse = stretch.tensor(-1.0);
  for (int c = 0; c < 4; ++c) {
    const Matrix3d strain_change = tensor_of(PlaneComponents::Unit(c));
    Matrix3d kirchhoff_change;
    kirchhoff_change.reshaped() =
        of_gradient * (stretch.change(strain_change) * inverse).reshaped();
    tangent.col(c) =
        components_of(kirchhoff_change) / volume - state.stress * strain_change.trace();
  }
  return state;
}

}  // namespace

double SoilElementState::deviator_stress() const {
  const Matrix3d deviator = tensor_of(stress) + mean_stress() * Matrix3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

SoilElement::SoilElement(const SkeletonModel& model, const PlaneComponents& stress,
                         double fines_left)
    : model_(model),
      state_{.stress = stress,
             .skeleton = {elastic_b_under(model.at(fines_left), tensor_of(stress))},
             .fines_left = fines_left} {}

bool SoilElement::is_admissible() const {
  const SkeletonResponse response = skeleton_response<3>(*model_.law, model_.at(state_.fines_left),
                                                         state_.skeleton, Matrix3d::Identity());
  return response.plastic_strain == 0.0;
}

double SoilElement::advance(const SoilElementTarget& target) {
  const SoilElementState start = state_;
  double share = 0.0;
  for (double step = 1.0; share < 1.0;) {
    const double next = std::min(1.0, share + step);
    SoilElementTarget part = target;
    for (int c = 0; c < 4; ++c) {
      const double from = target.is_stress[c] ? start.stress[c] : start.strain[c];
      part.value[c] = std::lerp(from, target.value[c], next);
    }
    part.fines_left = std::lerp(start.fines_left, target.fines_left, next);
    if (try_step(part)) {
      share = next;
      step *= 2.0;
    } else if ((step *= 0.5) < smallest_share) {
      break;
    }
  }
  return share;
}

/// Newton's method for the strains of the prescribed stresses. Changes the state if it converges.
bool SoilElement::try_step(const SoilElementTarget& target) {
  std::vector<int> unknown;
  PlaneComponents strain = state_.strain;
  for (int c = 0; c < 4; ++c) {
    if (target.is_stress[c]) {
      unknown.push_back(c);
    } else {
      strain[c] = target.value[c];
    }
  }
  Matrix4d tangent;
  const auto state_of = [&] {
    return state_at(model_, state_, strain, target.fines_left, tangent);
  };
  const auto error_of = [&](const SoilElementState& state) {
    return Eigen::VectorXd((state.stress - target.value)(unknown));
  };
  SoilElementState state = state_of();
  Eigen::VectorXd error = error_of(state);
  for (int i = 0; i < most_iterations && error.allFinite(); ++i) {
    const double round_off = 1e-14 * model_.at(target.fines_left).young;
    const double size = state.stress.cwiseAbs().maxCoeff();
    if (unknown.empty() || error.cwiseAbs().maxCoeff() <= 1e-12 * size + round_off) {
      state_ = state;
      return true;
    }
    // Takes the smallest change of the strains if they are not unique, such as the lateral strains
    // of soil that flows in a triaxial cell: directions with equal stress then strain equally.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-9);
    solver.compute(tangent(unknown, unknown));
    Eigen::VectorXd change = -solver.solve(error);
    const PlaneComponents base = strain;
    const double former = error.norm();
    for (int halvings = 0; halvings <= most_halvings; ++halvings, change *= 0.5) {
      strain = base;
      strain(unknown) += change;
      state = state_of();
      error = error_of(state);
      if (error.norm() < former) break;
    }
  }
  return false;
}

}  // namespace suffuse
