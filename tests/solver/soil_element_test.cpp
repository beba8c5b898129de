#include "physics/skeleton/soil_element.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/skeleton/skeleton_law.hpp"

namespace suffuse {
namespace soil_element_test {

SkeletonModel elastic(double young, double poisson) {
  return {.law = skeleton_law("elastic"), .young = young, .poisson = poisson};
}

SkeletonModel sliding(double friction, double cohesion, double dilation) {
  return {.law = skeleton_law("mohr-coulomb"),
          .young = 2e7,
          .poisson = 0.3,
          .friction = friction,
          .cohesion = cohesion,
          .dilation = dilation};
}

/// xx and zz keep their stress, yy is shortened, as in a triaxial test.
SoilElementTarget triaxial(double confinement, double axial_strain, double fines_left = 1.0) {
  return {.value = {-confinement, axial_strain, -confinement, 0.0},
          .is_stress = {true, false, true, false},
          .fines_left = fines_left};
}

PlaneComponents isotropic(double stress) {
  return {-stress, -stress, -stress, 0.0};
}

TEST(SoilElement, oedometer_at_large_strain) {
  const SkeletonModel model = elastic(1e6, 0.0);
  SoilElement element(model, PlaneComponents::Zero(), 1.0);
  EXPECT_EQ(
      element.advance({.value = {0.0, -0.5e6, 0.0, 0.0}, .is_stress = {false, true, false, false}}),
      1.0);
  // 2 W(1/2), W being Lambert's function.
  EXPECT_NEAR(std::exp(element.state().strain[1]), 0.7034674225, 1e-10);
}

TEST(SoilElement, isotropic_compression) {
  const SkeletonModel model = elastic(1e6, 0.2);
  SoilElement element(model, PlaneComponents::Zero(), 1.0);
  EXPECT_EQ(element.advance({.value = isotropic(3e5), .is_stress = {true, true, true, false}}),
            1.0);
  const double volume = element.state().volumetric_strain();
  const double bulk = 1e6 / (3.0 * (1.0 - 0.4));
  EXPECT_NEAR(3e5 * std::exp(volume), -bulk * volume, 1e-6);
  EXPECT_NEAR(element.state().strain[0], volume / 3.0, 1e-14);
  EXPECT_NEAR(element.state().deviator_stress(), 0.0, 1e-6);
}

/// sigma_1 = sigma_3 K + 2 (c/J) sqrt(K), K = (1 + sin phi)/(1 - sin phi): c refers to the
/// Kirchhoff stress, J is the volume over the initial one.
TEST(SoilElement, drained_triaxial_strength_is_that_of_mohr_and_coulomb) {
  for (const double cohesion : {0.0, 1e4}) {
    const SkeletonModel model = sliding(34.0, cohesion, 8.0);
    SoilElement element(model, isotropic(1e5), 1.0);
    ASSERT_EQ(element.advance(triaxial(1e5, -0.1)), 1.0);
    const SoilElementState& state = element.state();
    const double s = std::sin(34.0 * std::numbers::pi / 180.0);
    const double ratio = (1.0 + s) / (1.0 - s);
    const double today = cohesion / std::exp(state.volumetric_strain());
    EXPECT_NEAR(-state.stress[1] / (1e5 * ratio + 2.0 * today * std::sqrt(ratio)), 1.0, 1e-11);
    EXPECT_NEAR(state.deviator_stress(), -state.stress[1] - 1e5, 1e-5);
    EXPECT_NEAR(state.strain[0], state.strain[2], 1e-12);
  }
}

TEST(SoilElement, flow_dilates_in_a_triaxial_test) {
  const SkeletonModel model = sliding(34.0, 0.0, 8.0);
  SoilElement element(model, isotropic(1e5), 1.0);
  ASSERT_EQ(element.advance(triaxial(1e5, -0.05)), 1.0);
  const SoilElementState before = element.state();
  ASSERT_EQ(element.advance(triaxial(1e5, -0.15)), 1.0);
  const SoilElementState& after = element.state();
  // The stress is constant, but the Kirchhoff stress grows with the volume, and so does elastic
  // strain.
  const double growth = std::exp(after.volumetric_strain()) - std::exp(before.volumetric_strain());
  const double axial = growth * (after.stress[1] + 0.6e5) / 2e7;
  const double lateral = growth * (-1e5 - 0.3 * (after.stress[1] - 1e5)) / 2e7;
  const double plastic_axial = after.strain[1] - before.strain[1] - axial;
  const double plastic_volume =
      after.volumetric_strain() - before.volumetric_strain() - axial - 2.0 * lateral;
  const double s = std::sin(8.0 * std::numbers::pi / 180.0);
  EXPECT_NEAR(plastic_volume / -plastic_axial, 2.0 * s / (1.0 - s), 1e-10);
}

/// Elastic strain stays when fines leave, so tau = C(E) (strain before + strain since).
TEST(SoilElement, strain_follows_the_modulus_that_is_left_at_constant_stress) {
  SkeletonModel model = elastic(1e7, 0.25);
  model.young = FinesFunction({{1.0, 1e7}, {0.0, 4e6}});
  const PlaneComponents stress(-1e5, -3e5, -2e5, 0.0);
  SoilElement element(model, stress, 1.0);
  ASSERT_EQ(
      element.advance({.value = stress, .is_stress = {true, true, true, false}, .fines_left = 0.5}),
      1.0);
  const SoilElementState& state = element.state();
  const double volume = std::exp(state.volumetric_strain());
  for (int c = 0; c < 3; ++c) {
    const double flexibility = 1.25 * stress[c] - 0.25 * stress.head<3>().sum();
    EXPECT_NEAR(state.strain[c], flexibility * (volume / 7e6 - 1.0 / 1e7), 1e-14);
    EXPECT_NEAR(state.stress[c], stress[c], 1e-6);
  }
}

TEST(SoilElement, stress_follows_the_modulus_that_is_left_at_constant_strain) {
  SkeletonModel model = elastic(1e7, 0.25);
  model.young = FinesFunction({{1.0, 1e7}, {0.0, 4e6}});
  const PlaneComponents stress(-1e5, -3e5, -2e5, 2e4);
  SoilElement element(model, stress, 1.0);
  ASSERT_EQ(element.advance({.fines_left = 0.25}), 1.0);
  EXPECT_LT((element.state().stress - 0.55 * stress).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_EQ(element.state().strain, PlaneComponents::Zero());
}

TEST(SoilElement, deviator_falls_to_the_weaker_limit) {
  SkeletonModel model = sliding(34.0, 5e3, 0.0);
  model.friction = FinesFunction({{1.0, 34.0}, {0.0, 28.0}});
  model.cohesion = FinesFunction({{1.0, 5e3}, {0.0, 1e3}});
  SoilElement element(model, isotropic(1e5), 1.0);
  ASSERT_EQ(element.advance(triaxial(1e5, -0.05)), 1.0);
  const double before = element.state().deviator_stress();
  ASSERT_EQ(element.advance(triaxial(1e5, -0.05, 0.0)), 1.0);
  const SoilElementState& state = element.state();
  const double s = std::sin(28.0 * std::numbers::pi / 180.0);
  const double cohesion = 1e3 / std::exp(state.volumetric_strain());
  const double strength =
      (2e5 * s + 2.0 * cohesion * std::cos(28.0 * std::numbers::pi / 180.0)) / (1.0 - s);
  EXPECT_NEAR(state.deviator_stress() / strength, 1.0, 1e-11);
  EXPECT_LT(state.deviator_stress(), 0.75 * before);
}

TEST(SoilElement, load_beyond_the_strength_is_found) {
  const SkeletonModel model = sliding(30.0, 0.0, 0.0);
  SoilElement element(model, isotropic(1e5), 1.0);
  const double share =
      element.advance({.value = {-1e5, -5e5, -1e5, 0.0}, .is_stress = {true, true, true, false}});
  EXPECT_NEAR(share, 0.5, 1e-4);  // share of the way from 1e5 to 5e5: sigma_1 = 3 sigma_3
  EXPECT_NEAR(element.state().stress[1], -3e5, 50.0);
  EXPECT_TRUE(element.is_admissible());
  EXPECT_FALSE(SoilElement(model, {-1e5, -4e5, -1e5, 0.0}, 1.0).is_admissible());
}

TEST(SoilElement, shear_under_constant_stress_stops_at_the_strength) {
  const SkeletonModel model = sliding(30.0, 0.0, 0.0);
  SoilElement element(model, isotropic(1e5), 1.0);
  ASSERT_EQ(
      element.advance({.value = {-1e5, -1e5, 0.0, 0.05}, .is_stress = {true, true, false, false}}),
      1.0);
  // Mohr's circle around 1e5: radius = 1e5 sin phi, because zz is the intermediate stress.
  EXPECT_NEAR(std::abs(element.state().stress[3]), 5e4, 1.0);
}

/// On a path that only loads, the state does not depend on the steps.
TEST(SoilElement, many_steps_lead_to_the_same_state) {
  const SkeletonModel model = sliding(34.0, 1e3, 8.0);
  SoilElement one(model, isotropic(1e5), 1.0);
  SoilElement many(model, isotropic(1e5), 1.0);
  ASSERT_EQ(one.advance(triaxial(1e5, -0.1)), 1.0);
  for (int k = 1; k <= 50; ++k) ASSERT_EQ(many.advance(triaxial(1e5, -0.002 * k)), 1.0);
  EXPECT_LT((one.state().strain - many.state().strain).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((one.state().stress - many.state().stress).cwiseAbs().maxCoeff(), 1e-4);
}

// -------------------------------------------------------------------------- modified Cam clay

constexpr double clay_young = 2e7;  // Pa
constexpr double clay_poisson = 0.25;
constexpr double clay_bulk = clay_young / (3.0 * (1.0 - 2.0 * clay_poisson));
constexpr double lambda = 0.04;
constexpr double start_limit = 1e5;  // p_c0, Pa

/// M
double critical_slope() {
  const double s = std::sin(25.0 * std::numbers::pi / 180.0);
  return 6.0 * s / (3.0 - s);
}

SkeletonModel clay() {
  return {.law = skeleton_law("cam-clay"),
          .young = clay_young,
          .poisson = clay_poisson,
          .friction = 25.0,
          .compression = lambda,
          .preconsolidation = start_limit};
}

/// Mean Kirchhoff stress (J times the stress), in which the law is written, Pa.
double kirchhoff_pressure(const SoilElementState& state) {
  return state.mean_stress() * std::exp(state.volumetric_strain());
}
double kirchhoff_shear(const SoilElementState& state) {
  return state.deviator_stress() * std::exp(state.volumetric_strain());
}

/// Virgin compression and unloading: -ln J = P/K + Lambda ln(P/p_c0), then along K.
TEST(CamClay, CompressesAlongItsLine) {
  const SkeletonModel model = clay();
  SoilElement element(model, isotropic(5e4), 1.0);
  for (const double pressure : {2e5, 4e5}) {
    ASSERT_EQ(
        element.advance({.value = isotropic(pressure), .is_stress = {true, true, true, false}}),
        1.0);
    const double p = kirchhoff_pressure(element.state());
    EXPECT_NEAR(element.state().volumetric_strain(),
                -(p - 5e4) / clay_bulk - lambda * std::log(p / start_limit), 1e-9);
  }
  const double packed = element.state().volumetric_strain();
  const double p = kirchhoff_pressure(element.state());
  ASSERT_EQ(element.advance({.value = isotropic(1e5), .is_stress = {true, true, true, false}}),
            1.0);
  EXPECT_NEAR(element.state().volumetric_strain() - packed,
              (p - kirchhoff_pressure(element.state())) / clay_bulk, 1e-12);
}

/// On a path of constant q/p = eta shear strain grows by 2 eta/(M^2 - eta^2) of the plastic
/// compaction, in one step as in many.
TEST(CamClay, ShearsInProportionOnARadialPath) {
  const double eta = 0.6;
  const double slope = critical_slope();
  const SkeletonModel model = clay();
  // p on the yield surface at the start.
  const double p_start = start_limit / (1.0 + eta * eta / (slope * slope));
  const auto stress = [&](double p) {
    const double q = eta * p;
    return PlaneComponents(-(p - q / 3.0), -(p + 2.0 * q / 3.0), -(p - q / 3.0), 0.0);
  };
  SoilElement element(model, stress(p_start), 1.0);
  ASSERT_EQ(
      element.advance({.value = stress(3.0 * p_start), .is_stress = {true, true, true, false}}),
      1.0);
  const SoilElementState& state = element.state();
  const double p = kirchhoff_pressure(state);
  const double q = kirchhoff_shear(state);
  EXPECT_NEAR(q / p, eta, 1e-9);
  const double compaction = lambda * std::log(p / p_start);
  EXPECT_NEAR(state.skeleton.internal, compaction, 1e-10);
  EXPECT_NEAR(state.volumetric_strain(), -(p - p_start) / clay_bulk - compaction, 1e-10);
  const double shear_modulus = clay_young / (2.0 * (1.0 + clay_poisson));
  const double shear = 2.0 / 3.0 * (state.strain[0] - state.strain[1]);
  EXPECT_NEAR(shear,
              (q - eta * p_start) / (3.0 * shear_modulus) +
                  compaction * 2.0 * eta / (slope * slope - eta * eta),
              1e-9);
}

/// At constant volume the soil ends at the critical state: q = M p, p_c = 2 p, and plastic
/// compaction equals elastic swelling.
TEST(CamClay, EndsAtTheCriticalStateAtConstantVolume) {
  for (const double p_start : {1e5, 1e4}) {  // on the wet side, and on the dry side
    const SkeletonModel model = clay();
    SoilElement element(model, isotropic(p_start), 1.0);
    for (int k = 1; k <= 400; ++k) {
      const double e = 1e-3 * k;
      ASSERT_EQ(element.advance({.value = {0.5 * e, -e, 0.5 * e, 0.0}}), 1.0);
    }
    // p_start - K v = p_c0 exp(v/Lambda)/2
    double low = -0.1;
    double high = 0.1;
    for (int k = 0; k < 100; ++k) {
      const double v = 0.5 * (low + high);
      const bool above = p_start - clay_bulk * v > 0.5 * start_limit * std::exp(v / lambda);
      (above ? low : high) = v;
    }
    const double p = p_start - clay_bulk * low;
    EXPECT_NEAR(kirchhoff_pressure(element.state()), p, 1e-4 * p);
    EXPECT_NEAR(kirchhoff_shear(element.state()), critical_slope() * p, 1e-4 * p);
  }
}

/// Backward Euler steps on a path that turns: the error is of first order.
TEST(CamClay, DrainedShearConvergesWithOrderOne) {
  const auto shear_stress = [](int steps) {
    const SkeletonModel model = clay();
    SoilElement element(model, isotropic(1e5), 1.0);
    for (int k = 1; k <= steps; ++k) {
      EXPECT_EQ(element.advance(triaxial(1e5, -0.05 * k / steps)), 1.0);
    }
    return element.state().deviator_stress();
  };
  const double exact = shear_stress(1600);
  const double coarse = std::abs(shear_stress(40) - exact);
  const double fine = std::abs(shear_stress(80) - exact);
  EXPECT_LT(fine, 0.01 * exact);
  EXPECT_NEAR(std::log2(coarse / fine), 1.0, 0.2);
}

}  // namespace soil_element_test
}  // namespace suffuse
