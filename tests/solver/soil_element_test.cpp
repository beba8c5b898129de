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

/// xx and zz keep their stress, yy is shortened: a triaxial test.
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
  // 2 W(1/2), W the function of Lambert.
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

/// sigma_1 = sigma_3 K + 2 (c/J) sqrt(K), K = (1 + sin phi)/(1 - sin phi): c is that of the
/// Kirchhoff stress, J the volume over the first.
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
  // The stress stays, but the Kirchhoff stress grows with the volume, and with it elastic strain.
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
  EXPECT_NEAR(share, 0.5, 1e-4);  // of the way from 1e5 to 5e5: sigma_1 = 3 sigma_3
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
  // Mohr's circle around 1e5: radius = 1e5 sin phi, as zz lies between.
  EXPECT_NEAR(std::abs(element.state().stress[3]), 5e4, 1.0);
}

/// Steps make no difference on a path that only loads.
TEST(SoilElement, many_steps_lead_to_the_same_state) {
  const SkeletonModel model = sliding(34.0, 1e3, 8.0);
  SoilElement one(model, isotropic(1e5), 1.0);
  SoilElement many(model, isotropic(1e5), 1.0);
  ASSERT_EQ(one.advance(triaxial(1e5, -0.1)), 1.0);
  for (int k = 1; k <= 50; ++k) ASSERT_EQ(many.advance(triaxial(1e5, -0.002 * k)), 1.0);
  EXPECT_LT((one.state().strain - many.state().strain).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((one.state().stress - many.state().stress).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace soil_element_test
}  // namespace suffuse
