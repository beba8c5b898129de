/// Blending of coefficients alone: continuous between steps, exact where densities drift.

#include "flow/coefficient_blending.hpp"

#include <gtest/gtest.h>

#include "mixed/implicit_thresholds.hpp"
#include "results/state_archive.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace coefficient_blending_test {

using model::FlowModel;
using model::Uniform;

constexpr BlendingSettings all_settings{true, true, 1000.0, 2700.0};

struct CoefficientBlendingTest : testing::Test {
  FlowModel m{model::column_mesh(3, 3)};
  FlowCoefficients<2> before = scattered(1);  ///< at the end of the last step
  FlowCoefficients<2> now = scattered(2);     ///< after transport

  [[nodiscard]] FlowCoefficients<2> scattered(unsigned seed) const {
    FlowCoefficients<2> c = m.forcing.coefficients;
    c.quadratic_drag.assign(c.drag.size(), 1e5);
    c.mixture_density.assign(c.drag.size(), 1500.0);
    Uniform uniform(seed);
    for (auto* values :
         {&c.porosity, &c.water_volume, &c.drag, &c.quadratic_drag, &c.mixture_density}) {
      for (double& v : *values) v *= 1.0 + 0.1 * uniform();
    }
    return c;
  }
  /// Largest relative difference of any coefficient.
  static double distance(const FlowCoefficients<2>& a, const FlowCoefficients<2>& b) {
    double largest = 0.0;
    const auto compare = [&](const std::vector<double>& x, const std::vector<double>& y) {
      for (std::size_t e = 0; e < x.size(); ++e) {
        largest = std::max(largest, std::abs(x[e] / y[e] - 1.0));
      }
    };
    compare(a.porosity, b.porosity);
    compare(a.water_volume, b.water_volume);
    compare(a.drag, b.drag);
    compare(a.quadratic_drag, b.quadratic_drag);
    compare(a.mixture_density, b.mixture_density);
    return largest;
  }
  [[nodiscard]] FlowCoefficients<2> blended(const CoefficientBlending<2>& blending,
                                            double elapsed) const {
    FlowCoefficients<2> result = now;
    blending.blend(elapsed, now, result);
    return result;
  }
};

TEST_F(CoefficientBlendingTest, AStepStartsWhereTheLastOneEndedAndReachesTheNewOnes) {
  CoefficientBlending<2> blending(all_settings);
  EXPECT_EQ(distance(blended(blending, 0.0), now), 0.0);
  blending.record(before);
  blending.finish(2.0);
  EXPECT_GE(distance(before, now), 0.05);
  EXPECT_LE(distance(blended(blending, 0.0), before), 1e-15);
  EXPECT_EQ(distance(blended(blending, 2.0), now), 0.0);
  EXPECT_EQ(distance(blended(blending, 3.0), now), 0.0);
  const FlowCoefficients<2> half = blended(blending, 1.0);
  for (std::size_t e = 0; e < half.drag.size(); ++e) {
    EXPECT_NEAR(half.drag[e], 0.5 * (before.drag[e] + now.drag[e]), 1e-14 * now.drag[e]);
  }
}

TEST_F(CoefficientBlendingTest, ShorterStepsDoNotBlendFasterAtOnce) {
  CoefficientBlending<2> blending(all_settings);
  blending.record(before);
  blending.finish(2.0);
  // A step of 0.4 s shortens the time of blending by half of its length, to 1.8 s.
  blending.finish(0.4);
  EXPECT_GT(distance(blended(blending, 1.79), now), 0.0);
  EXPECT_EQ(distance(blended(blending, 1.81), now), 0.0);
}

TEST_F(CoefficientBlendingTest, AfterABreakpointTheyBlendInAHundredthOfAStep) {
  CoefficientBlending<2> blending(all_settings);
  blending.record(before);
  blending.finish(2.0);
  blending.shorten(2.0);
  EXPECT_LE(distance(blended(blending, 0.0), before), 1e-15);
  const double time = implicit_thresholds.breakpoint_blending * 2.0;
  EXPECT_EQ(time, 0.02);
  EXPECT_GT(distance(blended(blending, 0.99 * time), now), 0.0);
  EXPECT_EQ(distance(blended(blending, 1.01 * time), now), 0.0);
}

TEST_F(CoefficientBlendingTest, WhereOnlyWaterChangesOnlyWaterIsBlended) {
  CoefficientBlending<2> blending({true, false, 1000.0, 2700.0});
  blending.record(before);
  blending.finish(2.0);
  const FlowCoefficients<2> at_start = blended(blending, 0.0);
  EXPECT_EQ(at_start.drag, now.drag);
  EXPECT_EQ(at_start.porosity, now.porosity);
  for (std::size_t e = 0; e < now.drag.size(); ++e) {
    EXPECT_NEAR(at_start.water_volume[e] / before.water_volume[e], 1.0, 1e-15);
  }
}

TEST_F(CoefficientBlendingTest, StepsOfGivenLengthTakeThemAsTheyAre) {
  CoefficientBlending<2> blending({false, true, 1000.0, 2700.0});
  blending.record(before);
  blending.finish(2.0);
  EXPECT_EQ(distance(blended(blending, 0.0), now), 0.0);
}

TEST_F(CoefficientBlendingTest, ADensityThatKeepsRisingIsExpectedTo) {
  // Transport adds 3 kg/m3 per second in element 4.
  CoefficientBlending<2> blending(all_settings);
  EXPECT_EQ(blending.learn(m.grid, now, 2.0, 1.0), 0.0);
  FlowCoefficients<2> expected = now;
  expected.mixture_density[4] -= 3.0 * 2.0;
  blending.expect(expected);
  EXPECT_TRUE(blending.expects());
  EXPECT_LE(blending.learn(m.grid, now, 2.0, 1.0), 1e-15);
  EXPECT_FALSE(blending.expects());
  const FlowCoefficients<2> later = blended(blending, 5.0);
  EXPECT_NEAR(later.mixture_density[4] - now.mixture_density[4], 15.0, 1e-9);
  EXPECT_EQ(later.mixture_density[3], now.mixture_density[3]);
  // The density of the mixture stays between those of its constituents.
  EXPECT_EQ(blended(blending, 1e6).mixture_density[4], 2700.0);
}

TEST_F(CoefficientBlendingTest, ScatterAveragesOut) {
  CoefficientBlending<2> blending(all_settings);
  for (int step = 0; step < 400; ++step) {
    FlowCoefficients<2> expected = now;
    expected.mixture_density[4] -= 3.0 + (step % 2 == 0 ? 30.0 : -30.0);
    blending.expect(expected);
    blending.learn(m.grid, now, 1.0, 0.02);
  }
  const double drift = blended(blending, 1.0).mixture_density[4] - now.mixture_density[4];
  EXPECT_NEAR(drift, 3.0, 0.02 * 30.0);
}

TEST_F(CoefficientBlendingTest, TellsHowWrongResistancesWere) {
  CoefficientBlending<2> blending(all_settings);
  FlowCoefficients<2> expected = now;
  expected.drag[4] *= 1.03;
  expected.drag[5] *= 1.2;
  expected.porosity[5] *= 1.2;
  blending.expect(expected);
  EXPECT_NEAR(blending.learn(m.grid, now, 1.0, 1.0), 0.03, 1e-12);
}

TEST_F(CoefficientBlendingTest, GoesOnAsArchived) {
  CoefficientBlending<2> blending(all_settings);
  FlowCoefficients<2> expected = now;
  expected.mixture_density[4] -= 6.0;
  blending.expect(expected);
  blending.learn(m.grid, now, 2.0, 1.0);
  blending.record(before);
  blending.finish(2.0);
  StateArchive stored;
  blending.archive(stored);
  StateArchive restored(stored.finish());
  CoefficientBlending<2> other(all_settings);
  other.archive(restored);
  restored.finish();
  EXPECT_EQ(distance(blended(other, 0.7), blended(blending, 0.7)), 0.0);
}

}  // namespace coefficient_blending_test
}  // namespace suffuse
