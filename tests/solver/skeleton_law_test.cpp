#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

#include "physics/skeleton/skeleton_response.hpp"

namespace suffuse {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180.0;

template <int Dim>
using Gradient = Eigen::Matrix<double, Dim, Dim>;

SkeletonParameters sand(double friction = 30.0, double cohesion = 0.01, double dilation = 10.0) {
  return {.young = 10.0,
          .poisson = 0.25,
          .friction = friction * degree,
          .cohesion = cohesion,
          .dilation = dilation * degree};
}

Matrix3d b_of(const Vector3d& strain, const Matrix3d& turn = Matrix3d::Identity()) {
  const Vector3d values = (2.0 * strain.array()).exp();
  return turn * values.asDiagonal() * turn.transpose();
}

/// P = tau F^-T of an increment.
template <int Dim>
Gradient<Dim> first_stress(const SkeletonLaw& law, const SkeletonParameters& p, const Matrix3d& b,
                           const Gradient<Dim>& increment) {
  const Matrix3d stress = skeleton_response<Dim>(law, p, b, increment).stress;
  return stress.topLeftCorner<Dim, Dim>() * increment.inverse().transpose();
}

/// Largest difference of the tangent from central differences of this half-width, over E.
template <int Dim>
double tangent_error(const SkeletonLaw& law, const SkeletonParameters& p, const Matrix3d& b,
                     const Gradient<Dim>& increment, double width) {
  DeformationTangent<Dim> tangent;
  skeleton_response<Dim>(law, p, b, increment, &tangent);
  double error = 0.0;
  for (int k = 0; k < Dim * Dim; ++k) {
    Gradient<Dim> step = Gradient<Dim>::Zero();
    step(k % Dim, k / Dim) = width;
    const Gradient<Dim> difference = (first_stress<Dim>(law, p, b, increment + step) -
                                      first_stress<Dim>(law, p, b, increment - step)) /
                                     (2.0 * width);
    const auto column = Eigen::Map<const Eigen::Vector<double, Dim * Dim>>(difference.data());
    error = std::max(error, (tangent.col(k) - column).cwiseAbs().maxCoeff() / p.young);
  }
  return error;
}

template <int Dim>
Gradient<Dim> random_increment(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> entry(-size, size);
  return Gradient<Dim>::Identity() + Gradient<Dim>::NullaryExpr([&] { return entry(random); });
}

Matrix3d random_turn(std::mt19937& random, bool in_plane) {
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  const Matrix3d about_z = Eigen::AngleAxisd(angle(random), Vector3d::UnitZ()).toRotationMatrix();
  if (in_plane) return about_z;
  return about_z * Eigen::AngleAxisd(angle(random), Vector3d::UnitX()).toRotationMatrix();
}

/// Kinks lie between a few of the differences: how many are off, and how far at most are the
/// others.
struct Comparison {
  int kinks = 0;
  int plastic = 0;
  double error = 0.0;
};

template <int Dim>
Comparison compare_tangents(const SkeletonLaw& law, const SkeletonParameters& p, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> strain(-0.3, 0.1);
  Comparison result;
  for (int k = 0; k < count; ++k) {
    const Matrix3d b =
        b_of({strain(random), strain(random), strain(random)}, random_turn(random, Dim == 2));
    const Gradient<Dim> increment = random_increment<Dim>(random, 0.1);
    const double error = tangent_error<Dim>(law, p, b, increment, 1e-6);
    const bool yields = skeleton_response<Dim>(law, p, b, increment).plastic_strain > 0.0;
    result.plastic += yields;
    if (error > 1e-3) {
      ++result.kinks;
    } else {
      result.error = std::max(result.error, error);
    }
  }
  return result;
}

TEST(SkeletonLaw, TangentIsTheDerivativeOfTheStress) {
  for (const SkeletonLaw* law : skeleton_laws()) {
    for (const SkeletonParameters& p :
         {sand(), sand(0.0, 0.5, 0.0), sand(35.0, 0.0, 0.0), sand(25.0, 0.2, 25.0)}) {
      const Comparison plane = compare_tangents<2>(*law, p, 500);
      const Comparison space = compare_tangents<3>(*law, p, 500);
      EXPECT_LT(plane.error, 1e-8) << law->word;
      EXPECT_LT(space.error, 1e-7) << law->word;
      EXPECT_LE(plane.kinks + space.kinks, 2) << law->word;
    }
  }
}

}  // namespace
}  // namespace suffuse
