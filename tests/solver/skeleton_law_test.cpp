#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "equilibrium/first_tangent.hpp"

namespace suffuse {
namespace skeleton_law_test {

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
          .dilation = dilation * degree,
          .compression = 0.05,
          .preconsolidation = 0.5};
}

Matrix3d b_of(const Vector3d& strain, const Matrix3d& turn = Matrix3d::Identity()) {
  const Vector3d values = (2.0 * strain.array()).exp();
  return turn * values.asDiagonal() * turn.transpose();
}

/// P = tau F^-T of an increment.
template <int Dim>
Gradient<Dim> first_stress(const SkeletonLaw& law, const SkeletonParameters& p, const Matrix3d& b,
                           const Gradient<Dim>& increment) {
  const Matrix3d stress = skeleton_response<Dim>(law, p, {b}, increment).stress;
  return stress.topLeftCorner<Dim, Dim>() * increment.inverse().transpose();
}

/// d P / d F of P = tau F^-T.
template <int Dim>
DeformationTangent<Dim> tangent_of_first(const SkeletonLaw& law, const SkeletonParameters& p,
                                         const Matrix3d& b, const Gradient<Dim>& increment) {
  DeformationTangent<Dim> of_stress;
  const Matrix3d stress = skeleton_response<Dim>(law, p, {b}, increment, &of_stress).stress;
  return first_tangent<Dim>(of_stress, stress.topLeftCorner<Dim, Dim>(), increment.inverse());
}

/// Largest difference of the tangent from central differences of this half-width, over E.
template <int Dim>
double tangent_error(const SkeletonLaw& law, const SkeletonParameters& p, const Matrix3d& b,
                     const Gradient<Dim>& increment, double width) {
  const DeformationTangent<Dim> tangent = tangent_of_first<Dim>(law, p, b, increment);
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

/// Some differences lie across kinks: the number of these, and the largest error of the others.
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
    const bool yields = skeleton_response<Dim>(law, p, {b}, increment).plastic_strain > 0.0;
    result.plastic += yields;
    if (error > 1e-3) {
      ++result.kinks;
    } else {
      result.error = std::max(result.error, error);
    }
  }
  return result;
}

/// Soils with friction, with and without cohesion and dilation, and one without friction.
std::vector<SkeletonParameters> soils() {
  return {sand(), sand(0.0, 0.5, 0.0), sand(35.0, 0.0, 0.0), sand(25.0, 0.2, 25.0)};
}

TEST(SkeletonLaw, tangent_is_the_derivative_of_the_stress) {
  for (const SkeletonLaw* law : skeleton_laws()) {
    for (const SkeletonParameters& p : soils()) {
      if (law->word == "cam-clay" && p.friction == 0.0) continue;  // refused
      const Comparison plane = compare_tangents<2>(*law, p, 500);
      const Comparison space = compare_tangents<3>(*law, p, 500);
      EXPECT_LT(plane.error, 1e-7) << law->word;
      EXPECT_LT(space.error, 1e-7) << law->word;
      EXPECT_LE(plane.kinks + space.kinks, 2) << law->word;
      if (law->word == "elastic") continue;
      EXPECT_GT(plane.plastic, 200) << law->word;
      EXPECT_GT(space.plastic, 200) << law->word;
    }
  }
}

TEST(SkeletonLaw, central_differences_approach_the_tangent_with_order_two) {
  const Matrix3d b = b_of({-0.03, -0.01, 0.002});
  Matrix3d increment;
  increment << 1.02, 0.01, 0.0, -0.02, 0.95, 0.03, 0.01, -0.01, 0.99;
  for (const SkeletonLaw* law : skeleton_laws()) {
    const double coarse = tangent_error<3>(*law, sand(), b, increment, 2e-4);
    const double fine = tangent_error<3>(*law, sand(), b, increment, 1e-4);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.02) << law->word;
  }
}

/// The share of a rotation goes over from a series to the exact function at a difference of
/// strains of sqrt(0.001).
TEST(SkeletonLaw, tangent_has_no_jump_where_its_series_ends) {
  const SkeletonLaw& law = *skeleton_law("elastic");
  const auto tangent_at = [&](double difference) {
    DeformationTangent<2> tangent;
    skeleton_response<2>(law, sand(), {b_of({difference, 0.0, 0.0})}, Gradient<2>::Identity(),
                         &tangent);
    return tangent;
  };
  const double end = std::sqrt(1e-3);
  const DeformationTangent<2> jump = tangent_at(end * (1 + 1e-13)) - tangent_at(end * (1 - 1e-13));
  EXPECT_LT(jump.cwiseAbs().maxCoeff(), 1e-13 * sand().young);
}

TEST(SkeletonLaw, tangent_is_symmetric_where_flow_is_associated) {
  std::mt19937 random(3);
  const auto asymmetry = [&](const SkeletonLaw& law, const SkeletonParameters& p) {
    double largest = 0.0;
    for (int k = 0; k < 200; ++k) {
      const Matrix3d b = b_of({-0.2, -0.05, -0.1}, random_turn(random, false));
      const DeformationTangent<3> tangent =
          tangent_of_first<3>(law, p, b, random_increment<3>(random, 0.2));
      largest = std::max(largest, (tangent - tangent.transpose()).cwiseAbs().maxCoeff());
    }
    return largest / p.young;
  };
  const SkeletonLaw& sliding = *skeleton_law("mohr-coulomb");
  EXPECT_LT(asymmetry(*skeleton_law("elastic"), sand()), 1e-14);
  EXPECT_LT(asymmetry(*skeleton_law("von-mises"), sand(0.0, 0.5, 0.0)), 1e-14);
  EXPECT_LT(asymmetry(sliding, sand(25.0, 0.2, 25.0)), 1e-14);
  EXPECT_LT(asymmetry(sliding, sand(0.0, 0.2, 0.0)), 1e-14);
  EXPECT_GT(asymmetry(sliding, sand(35.0, 0.0, 0.0)), 1e-2);
}

TEST(SkeletonLaw, a_body_that_turns_carries_its_stress_along) {
  std::mt19937 random(5);
  for (const SkeletonLaw* law : skeleton_laws()) {
    for (int k = 0; k < 100; ++k) {
      const Matrix3d turn = random_turn(random, false);
      const Matrix3d b = b_of({-0.1, -0.02, -0.05}, random_turn(random, false));
      const Matrix3d increment = random_increment<3>(random, 0.1);
      const auto straight = skeleton_response<3>(*law, sand(), {b}, increment);
      // Rotates the increment, and rotates everything.
      const auto turned = skeleton_response<3>(*law, sand(), {b}, turn * increment);
      const auto whole = skeleton_response<3>(*law, sand(), {turn * b * turn.transpose()},
                                              turn * increment * turn.transpose());
      for (const auto& other : {turned, whole}) {
        const Matrix3d stress = turn * straight.stress * turn.transpose();
        const Matrix3d left = turn * straight.state.elastic_b * turn.transpose();
        EXPECT_LT((other.stress - stress).cwiseAbs().maxCoeff(), 1e-13 * sand().young);
        EXPECT_LT((other.state.elastic_b - left).cwiseAbs().maxCoeff(), 1e-13);
        EXPECT_NEAR(other.plastic_strain, straight.plastic_strain, 1e-13);
      }
    }
  }
}

TEST(SkeletonLaw, plane_strain_is_space_without_strain_across) {
  std::mt19937 random(9);
  for (const SkeletonLaw* law : skeleton_laws()) {
    for (int k = 0; k < 100; ++k) {
      const Matrix3d b = b_of({-0.1, -0.02, -0.05}, random_turn(random, true));
      const Matrix2d increment = random_increment<2>(random, 0.1);
      Matrix3d in_space = Matrix3d::Identity();
      in_space.topLeftCorner<2, 2>() = increment;
      DeformationTangent<2> tangent;
      DeformationTangent<3> tangent_in_space;
      const auto plane = skeleton_response<2>(*law, sand(), {b}, increment, &tangent);
      const auto space = skeleton_response<3>(*law, sand(), {b}, in_space, &tangent_in_space);
      EXPECT_LT((plane.stress - space.stress).cwiseAbs().maxCoeff(), 1e-13 * sand().young);
      EXPECT_LT((plane.state.elastic_b - space.state.elastic_b).cwiseAbs().maxCoeff(), 1e-13);
      const std::array<int, 4> of_plane{0, 1, 3, 4};
      const Eigen::Matrix4d part = tangent_in_space(of_plane, of_plane);
      EXPECT_LT((tangent - part).cwiseAbs().maxCoeff(), 1e-12 * sand().young) << law->word;
    }
  }
}

TEST(SkeletonLaw, equal_principal_strains_cost_no_accuracy) {
  // The tangent is Lipschitz-continuous there: no difference may grow as strains approach each
  // other.
  Matrix3d direction;
  direction << 1.0, 0.3, -0.2, 0.3, -1.0, 0.4, -0.2, 0.4, 0.5;
  for (const SkeletonLaw* law : skeleton_laws()) {
    // Elastic strains, strains at the edges of largest and smallest stress, and beyond the apex.
    for (const Vector3d& strain :
         {Vector3d(-0.01, -0.01, -0.01), Vector3d(0.0, 0.0, 0.0), Vector3d(-0.2, 0.02, 0.02),
          Vector3d(0.05, -0.1, -0.1), Vector3d(0.1, 0.1, 0.1)}) {
      // Clay without stress lies on its surface, where the response has a kink.
      if (law->word == "cam-clay" && strain.isZero()) continue;
      const Matrix3d increment = Matrix3d::Identity();
      DeformationTangent<3> equal;
      skeleton_response<3>(*law, sand(), {b_of(strain)}, increment, &equal);
      for (const double apart : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16}) {
        DeformationTangent<3> tangent;
        skeleton_response<3>(*law, sand(), {b_of(strain) + apart * direction}, increment, &tangent);
        const double difference = (tangent - equal).cwiseAbs().maxCoeff() / sand().young;
        EXPECT_LT(difference, 100.0 * apart + 1e-12) << law->word << ' ' << strain.transpose();
      }
    }
  }
}

TEST(SkeletonLaw, no_strain_makes_what_is_not_a_number) {
  for (const SkeletonLaw* law : skeleton_laws()) {
    for (const SkeletonParameters& p : soils()) {
      if (law->word == "cam-clay" && p.friction == 0.0) continue;  // refused
      for (const double stretch : {1e-6, 1e-3, 0.5, 1.0, 2.0, 1e3, 1e6}) {
        for (const double other : {1e-3, 1.0, 1e3}) {
          const Matrix3d increment = Vector3d(stretch, stretch, other).asDiagonal();
          DeformationTangent<3> tangent;
          const auto after =
              skeleton_response<3>(*law, p, {Matrix3d::Identity()}, increment, &tangent);
          EXPECT_TRUE(after.stress.allFinite() && tangent.allFinite()) << law->word;
          EXPECT_TRUE(after.state.elastic_b.allFinite() && after.plastic_strain >= 0.0)
              << law->word;
          DeformationTangent<2> in_plane;
          const auto plane = skeleton_response<2>(
              *law, p, {Matrix3d::Identity()},
              Matrix2d(Vector3d(stretch, other, 1.0).head<2>().asDiagonal()), &in_plane);
          EXPECT_TRUE(plane.stress.allFinite() && in_plane.allFinite()) << law->word;
        }
      }
    }
  }
}

TEST(ElasticLaw, stress_is_linear_in_the_logarithm_of_stretches) {
  const SkeletonParameters p{.young = 3.0, .poisson = 0.2};
  const double shear = 3.0 / 2.4;
  const double lame = 3.0 * 0.2 / (1.2 * 0.6);
  const Matrix3d increment = Vector3d(0.5, 2.0, 3.0).asDiagonal();
  const auto at =
      skeleton_response<3>(*skeleton_law("elastic"), p, {Matrix3d::Identity()}, increment);
  EXPECT_NEAR(at.stress(0, 0), lame * std::log(3.0) + 2.0 * shear * std::log(0.5), 1e-14);
  EXPECT_NEAR(at.stress(2, 2), (lame + 2.0 * shear) * std::log(3.0), 1e-14);
  EXPECT_EQ(at.plastic_strain, 0.0);
}

TEST(ElasticLaw, b_under_a_stress_gives_that_stress) {
  Matrix3d stress;
  stress << -0.3, 0.05, 0.0, 0.05, -0.5, 0.0, 0.0, 0.0, -0.2;
  const auto at = skeleton_response<2>(*skeleton_law("elastic"), sand(),
                                       {elastic_b_under(sand(), stress)}, Matrix2d::Identity());
  EXPECT_LT((at.stress - stress).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(VonMisesLaw, pure_shear_stops_at_the_cohesion) {
  const SkeletonParameters p{.young = 100.0, .poisson = 0.3, .cohesion = 0.7};
  const double strain = 0.1;
  const Matrix3d increment = Vector3d(std::exp(strain), std::exp(-strain), 1.0).asDiagonal();
  const auto at =
      skeleton_response<3>(*skeleton_law("von-mises"), p, {Matrix3d::Identity()}, increment);
  EXPECT_NEAR(at.stress(0, 0), 0.7, 1e-13);
  EXPECT_NEAR(at.stress(1, 1), -0.7, 1e-13);
  EXPECT_NEAR(at.stress(2, 2), 0.0, 1e-13);
  // The remaining elastic strain is c/(2 G), in both directions.
  const double plastic = strain - 0.7 / (2.0 * p.shear_modulus());
  EXPECT_NEAR(at.plastic_strain, std::sqrt(4.0 / 3.0) * plastic, 1e-14);
}

/// Largest of (1 + sin phi) tau_i - (1 - sin phi) tau_j - 2 c cos phi.
double excess_over_strength(const SkeletonParameters& p, const Vector3d& stress) {
  const double s = std::sin(p.friction);
  return (1.0 + s) * stress.maxCoeff() - (1.0 - s) * stress.minCoeff() -
         2.0 * p.cohesion * std::cos(p.friction);
}

/// Trial strains of all kinds, also close to planes, edges and the apex.
template <class Check>
void for_trial_strains(Check check) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-0.2, 0.2);
  for (int k = 0; k < 3000; ++k) {
    const double mean = part(random) - 0.05;
    Vector3d trial(part(random), part(random), part(random));
    trial.array() += mean - trial.mean();
    if (k % 3 == 0) trial[k % 2] = trial[2];
    check(trial);
  }
}

TEST(MohrCoulombLaw, stress_returns_to_the_limit) {
  const SkeletonLaw& law = *skeleton_law("mohr-coulomb");
  for (const SkeletonParameters& p : soils()) {
    for_trial_strains([&](const Vector3d& trial) {
      const PrincipalResponse at = law.respond(p, trial, 0.0);
      const double excess = excess_over_strength(p, at.stress);
      EXPECT_LT(excess, 2e-12 * p.young);
      if (at.plastic_strain > 0.0) {
        EXPECT_GT(excess, -1e-12 * p.young);
      }
      // A stress that was returned to the limit stays there.
      const PrincipalResponse again = law.respond(p, at.elastic_strain, 0.0);
      EXPECT_EQ(again.plastic_strain, 0.0);
      EXPECT_LT((again.stress - at.stress).cwiseAbs().maxCoeff(), 1e-13 * p.young);
    });
  }
}

/// Where flow is associated, no stress within the strength takes more work from the plastic strain.
TEST(MohrCoulombLaw, associated_flow_takes_the_most_work) {
  const SkeletonLaw& law = *skeleton_law("mohr-coulomb");
  std::mt19937 random(13);
  std::uniform_real_distribution<double> part(-3.0, 1.0);
  for (const SkeletonParameters& p : {sand(25.0, 0.2, 25.0), sand(0.0, 0.5, 0.0)}) {
    std::vector<Vector3d> bearable;
    while (bearable.size() < 300) {
      const Vector3d stress(part(random), part(random), part(random));
      if (excess_over_strength(p, stress) <= 0.0) bearable.push_back(stress);
    }
    for_trial_strains([&](const Vector3d& trial) {
      const PrincipalResponse at = law.respond(p, trial, 0.0);
      const Vector3d plastic = trial - at.elastic_strain;
      for (const Vector3d& other : bearable) {
        EXPECT_GE(plastic.dot(at.stress - other), -1e-12);
      }
    });
  }
}

/// Non-associated flow is a sum of the flows of the active planes, with positive weights.
TEST(MohrCoulombLaw, flow_dilates_as_the_angle_says) {
  const SkeletonLaw& law = *skeleton_law("mohr-coulomb");
  const SkeletonParameters p = sand(35.0, 0.1, 12.0);
  const double s = std::sin(p.dilation);
  const double apex = p.cohesion / std::tan(p.friction);
  int flowing = 0;
  for_trial_strains([&](const Vector3d& trial) {
    const PrincipalResponse at = law.respond(p, trial, 0.0);
    const Vector3d plastic = trial - at.elastic_strain;
    if (at.plastic_strain == 0.0 || at.stress.maxCoeff() > apex - 1e-9) return;
    ++flowing;
    // For any such sum, the ratio of extension to shortening is known.
    const double stretching = plastic.cwiseMax(0.0).sum();
    const double shortening = -plastic.cwiseMin(0.0).sum();
    EXPECT_NEAR(stretching * (1.0 - s), shortening * (1.0 + s), 1e-12);
    EXPECT_GT(shortening, 0.0);
    EXPECT_GE(plastic.dot(at.stress), 0.0);
  });
  EXPECT_GT(flowing, 500);
}

TEST(MohrCoulombLaw, soil_without_cohesion_bears_no_tension) {
  const SkeletonParameters p = sand(30.0, 0.0, 0.0);
  const Matrix3d increment = Vector3d(1.1, 1.05, 1.2).asDiagonal();
  DeformationTangent<3> tangent;
  const auto at = skeleton_response<3>(*skeleton_law("mohr-coulomb"), p, {Matrix3d::Identity()},
                                       increment, &tangent);
  EXPECT_EQ(at.stress.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(tangent.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LT((at.state.elastic_b - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(FinesFunction, is_linear_between_pairs_in_either_order) {
  const FinesFunction up({{0.0, 28.0}, {0.5, 30.0}, {1.0, 34.0}});
  const FinesFunction down({{1.0, 34.0}, {0.5, 30.0}, {0.0, 28.0}});
  EXPECT_EQ(up, down);
  EXPECT_EQ(down.value(1.0), 34.0);
  EXPECT_EQ(down.value(0.75), 32.0);
  EXPECT_EQ(down.value(0.25), 29.0);
  EXPECT_EQ(down.value(0.0), 28.0);
  EXPECT_EQ(down.smallest(), 28.0);
  const FinesFunction part({{0.8, 1.0}, {0.2, 3.0}});
  EXPECT_EQ(part.value(0.9), 1.0);
  EXPECT_EQ(part.value(0.1), 3.0);
  EXPECT_EQ(FinesFunction(7.0).value(0.3), 7.0);
}

}  // namespace skeleton_law_test
}  // namespace suffuse
