/// Relaxation of the mass error alone: how fast a mismatch falls, and that the volume released from
/// the elements crosses the boundary.

#include "flow/mass_relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "results/state_archive.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace mass_relaxation_test {

using model::FlowModel;
using model::Uniform;

/// Smallest change of a mismatch per step that counts, m3 per m3 of water: 16 units in the last
/// place.
constexpr double round_off = 16.0 * std::numeric_limits<double>::epsilon();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// An element that gains `growth` m3/s of water too much and releases what relaxation requests.
struct Element {
  MassRelaxation relaxation;
  double mismatch;
  double growth = 0.0;
  double let_out = 0.0;

  explicit Element(double start) : mismatch(start) { relaxation.observe({start}, {1.0}); }
  void step(double dt, double filling_time) {
    const std::vector<double> source = relaxation.next_source(dt, filling_time);
    relaxation.set_source(source);
    relaxation.finish(dt, filling_time);
    let_out += dt * source[0];
    mismatch += dt * (growth - source[0]);
    relaxation.observe({mismatch}, {1.0});
  }
};

TEST(MassRelaxation, WithoutAMismatchThereIsNoSource) {
  const MassRelaxation relaxation;
  EXPECT_FALSE(relaxation.active());
  EXPECT_TRUE(relaxation.source().empty());
}

TEST(MassRelaxation, EqualStepsTakeAQuarterOfTheMismatchEach) {
  Element element(1e-4);
  for (int n = 1; n <= 20; ++n) {
    element.step(0.5, 0.0);
    EXPECT_NEAR(element.mismatch, 1e-4 * std::pow(0.75, n), n * round_off) << n;
  }
}

/// What appears at once, in a step however short, must not be let out at that rate in a long one.
TEST(MassRelaxation, DoesNotRepeatTheGrowthOfAShortStepInALongOne) {
  constexpr double at_once = 1e-7;
  constexpr double seconds = 1e-6;
  Element element(0.0);
  element.relaxation.pass_kink();
  element.growth = at_once / seconds;
  element.step(seconds, 0.0);
  element.growth = 0.0;
  element.step(1.0, 0.0);
  EXPECT_LT(std::abs(element.mismatch), 5.0 * at_once);
}

TEST(MassRelaxation, IsNoFasterThanTheFlowPassesThroughAnElement) {
  Element element(1e-4);
  for (int n = 1; n <= 100; ++n) element.step(0.5, 50.0);
  EXPECT_NEAR(element.mismatch, 1e-4 * std::pow(1.0 - 0.5 / 50.0, 100), 100 * round_off);
  EXPECT_NEAR(element.mismatch / (1e-4 * std::exp(-1.0)), 1.0, 0.01);
}

TEST(MassRelaxation, SteadyGrowthIsLetOutAsItComes) {
  // A purely proportional release would keep a mismatch of 4 dt growth = 2e-5.
  Element element(0.0);
  element.growth = 1e-5;
  std::vector<double> mismatch;
  for (int n = 0; n < 40; ++n) {
    element.step(0.5, 0.0);
    mismatch.push_back(element.mismatch);
  }
  EXPECT_LE(std::abs(mismatch.back()), 1e-9);
  EXPECT_NEAR(mismatch[20] / mismatch[19], 0.75, 1e-6);
  EXPECT_NEAR(element.relaxation.source()[0], 1e-5, 1e-9);
  EXPECT_NEAR(element.let_out, 40 * 0.5 * 1e-5, 1e-9);
}

TEST(MassRelaxation, WhatLeavesTheElementsCrossesTheBoundary) {
  // Incompressible water in elements that hold too much or too little of it: the net outflow of
  // each is what it releases.
  FlowModel m(model::column_mesh(5, 7, 1.0, 1.0, model::jittered(0.03, 4)));
  m.set("bottom", FaceKind::pressure, 0.0);
  ImplicitMixed<2> flow(m.grid, {}, Vector<2>::Zero());
  Uniform uniform(8);
  std::vector<double> mismatch(m.mesh.element_count());
  for (double& v : mismatch) v = 1e-5 * uniform();
  const std::vector<double> first = mismatch;
  MassRelaxation relaxation;
  relaxation.observe(mismatch, m.forcing.coefficients.water_volume);
  MixedState<2> state = m.rest();
  double out = 0.0;
  constexpr int steps = 12;
  for (int n = 0; n < steps; ++n) {
    m.forcing.source = relaxation.next_source(2.0, 0.0);
    const MixedStep<2> step = flow.step(state, 2.0, m.constant(flow));
    for (int e = 0; e < m.mesh.element_count(); ++e) {
      for (int k = 0; k < 3; ++k) {
        const int f = m.grid.element_face[e][k];
        const double volume = m.grid.element_face_sign[e][k] * step.face_volume[f];
        mismatch[e] -= volume;
        if (m.grid.is_outer(f)) out += volume;
      }
    }
    state = step.end;
    relaxation.set_source(m.forcing.source);
    relaxation.finish(2.0, 0.0);
    relaxation.observe(mismatch, m.forcing.coefficients.water_volume);
  }
  const double sum = std::accumulate(first.begin(), first.end(), 0.0);
  const double rest = std::accumulate(mismatch.begin(), mismatch.end(), 0.0);
  EXPECT_NEAR(out, sum - rest, 1e-16);
  for (std::size_t e = 0; e < first.size(); ++e) {
    EXPECT_NEAR(mismatch[e], first[e] * std::pow(0.75, steps), 1e-16) << e;
  }
}

TEST(MassRelaxation, ShortStepsChangeTheSourceByLittle) {
  Element element(1e-4);
  for (int n = 0; n < 3; ++n) element.step(1.0, 1.0);
  const double source = element.relaxation.source()[0];
  for (const double dt : {0.1, 0.01, 0.001}) {
    const double wanted = element.relaxation.wanted_source(dt, infinite)[0];
    const double next = element.relaxation.next_source(dt, infinite)[0];
    EXPECT_NEAR((next - source) / (wanted - source), dt, 1e-12);
  }
}

TEST(MassRelaxation, BehindAKinkTheRateOfTheFirstStepCounts) {
  // A mismatch that grew by 1e-5 m3/s in steps of 1e6 s stops growing.
  const auto rate_after = [](bool passes_kink) {
    Element element(0.0);
    element.growth = 1e-5;
    for (int n = 0; n < 40; ++n) element.step(1e6, 1e3);
    element.growth = 0.0;
    if (passes_kink) element.relaxation.pass_kink();
    element.step(1.0, 1e3);
    return element.relaxation.wanted_source(1.0, infinite)[0];
  };
  EXPECT_NEAR(rate_after(true), 0.0, 1e-10);
  EXPECT_NEAR(rate_after(false), 1e-5, 1e-8);
}

TEST(MassRelaxation, RoundOffOfAVolumeIsNoRate) {
  MassRelaxation relaxation;
  relaxation.observe({0.0}, {1.0});
  relaxation.finish(1e-12, infinite);
  relaxation.observe({1e-15}, {1.0});
  EXPECT_EQ(relaxation.wanted_source(1e-12, infinite)[0], 0.0);
}

TEST(MassRelaxation, GoesOnAsArchived) {
  Element element(1e-4);
  for (int n = 0; n < 3; ++n) element.step(1.0, 1.0);
  StateArchive stored;
  element.relaxation.archive(stored);
  StateArchive restored(stored.finish());
  MassRelaxation other;
  other.archive(restored);
  restored.finish();
  EXPECT_EQ(other.next_source(0.3, 0.0), element.relaxation.next_source(0.3, 0.0));
  EXPECT_EQ(other.source(), element.relaxation.source());
}

}  // namespace mass_relaxation_test
}  // namespace suffuse
