#include "solid/rigid_skeleton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "solid/pores.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace rigid_skeleton_test {

/// Solid points of a small column of eroding soil.
struct SolidCase {
  explicit SolidCase(double rate, double start = 0.0)
      : input(make(rate, start)),
        grid(input.mesh),
        soils(input),
        solid(grid, soils, soils.exchange_span(false), 1) {}

  static Case<2> make(double rate, double start) {
    Scene scene = model::paper_scene();
    scene.soils[0].erosion.law = erosion_law("constant");
    scene.soils[0].erosion.rate = rate;
    scene.soils[0].erosion.start = start;
    return model::make_case(model::column_mesh(4, 4), scene);
  }
  [[nodiscard]] double solid_volume() const {
    double sum = 0.0;
    for (int p = 0; p < soils.points().size(); ++p) sum += solid.state().solid_volume(p);
    return sum;
  }

  Case<2> input;
  Grid<2> grid;
  SoilMap<2> soils;
  RigidSkeleton<2> solid;
};

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(RigidSkeleton, PorosityFollowsFromWhatPointsHold) {
  SolidCase c(1e-3);
  EXPECT_NEAR(c.solid_volume(), 0.7, 1e-14);
  EXPECT_NEAR(total(c.solid.state().erodible_volume), 0.1, 1e-14);
  std::vector<double> exchange;
  c.solid.exchange(0.0, 40.0, {}, {}, exchange);
  EXPECT_NEAR(total(exchange), 0.04, 1e-14);
  EXPECT_NEAR(c.solid_volume(), 0.66, 1e-14);
  for (const double n : c.solid.porosity()) EXPECT_NEAR(n, 0.34, 1e-15);
  for (const double n : c.solid.element_porosity()) EXPECT_NEAR(n, 0.34, 1e-15);
}

TEST(RigidSkeleton, ExchangeIsWhatTheStateLost) {
  // A hundred thousand steps of equal length, whose round-off has the same sign.
  SolidCase c(1e-3);
  const std::vector<double> before = c.solid.state().erodible_volume;
  std::vector<double> received(before.size(), 0.0);
  std::vector<double> exchange;
  for (int k = 0; k < 100000; ++k) {
    const double last = c.solid.state().erodible_volume[7];
    c.solid.exchange(k * 6e-4, (k + 1) * 6e-4, {}, {}, exchange);
    EXPECT_EQ(last - c.solid.state().erodible_volume[7], exchange[7]);
    received[7] += exchange[7];
  }
  EXPECT_NEAR(received[7] + c.solid.state().erodible_volume[7], before[7], 1e-12 * before[7]);
  EXPECT_NEAR(c.solid.porosity()[7], 0.36, 1e-11);
}

TEST(RigidSkeleton, ExhaustionLeavesTheCoarseGrains) {
  SolidCase c(5e-3, 2.0);
  EXPECT_EQ(c.soils.erosion_breakpoints({}).front(), 2.0);
  EXPECT_NEAR(c.soils.erosion_breakpoints({}).back(), 22.0, 1e-12);
  std::vector<double> exchange;
  for (double t = 0.0; t < 30.0; t += 0.7) c.solid.exchange(t, t + 0.7, {}, {}, exchange);
  for (int p = 0; p < c.soils.points().size(); ++p) {
    EXPECT_EQ(c.solid.state().erodible_volume[p], 0.0);
    EXPECT_EQ(c.solid.state().solid_volume(p), c.solid.state().skeleton_volume[p]);
    EXPECT_NEAR(c.solid.porosity()[p], 0.4, 1e-15);
    EXPECT_EQ(exchange[p], 0.0);
  }
  EXPECT_FALSE(c.solid.exchanges_within(30.0, 40.0));
  EXPECT_FALSE(c.solid.exchanges_within(0.0, 2.0));
}

TEST(RigidSkeleton, ElementsThatWaitStayAsTheyAre) {
  SolidCase c(1e-3);
  std::vector<char> excluded(c.input.mesh.elements.size(), 0);
  excluded[3] = 1;
  std::vector<double> exchange;
  c.solid.exchange(0.0, 10.0, {}, excluded, exchange);
  for (int p = 0; p < c.soils.points().size(); ++p) {
    const bool waits = c.soils.points().element[p] == 3;
    EXPECT_NEAR(exchange[p], waits ? 0.0 : 0.01 * c.soils.points().volume[p], 1e-17);
  }
}

TEST(RigidSkeleton, IsRestoredToTheLastBit) {
  SolidCase one(1e-3);
  std::vector<double> exchange;
  one.solid.exchange(0.0, 12.34, {}, {}, exchange);
  StateArchive out;
  one.solid.archive(out);
  SolidCase other(1e-3);
  StateArchive in(out.finish());
  other.solid.archive(in);
  EXPECT_EQ(one.solid.porosity(), other.solid.porosity());
  EXPECT_EQ(one.solid.state().erodible_volume, other.solid.state().erodible_volume);
}

TEST(PoreForecast, IsWhatErosionThenDoes) {
  SolidCase c(1e-3);
  PoreState now;
  now.porosity = c.solid.element_porosity();
  now.water_volume.assign(now.porosity.size(), 0.0);
  now.concentration.assign(now.porosity.size(), 0.05);
  const FluxHistory flux;
  const PointFlows liquid;
  const PoreForecast<2> forecast(c.grid, c.solid, 0.0, now, liquid, flux, 1);
  const PoreState ahead = forecast.at(30.0);
  std::vector<double> exchange;
  c.solid.exchange(0.0, 30.0, {}, {}, exchange);
  const std::vector<double> then = c.solid.element_porosity();
  for (std::size_t e = 0; e < then.size(); ++e) {
    EXPECT_NEAR(ahead.porosity[e], then[e], 1e-15);
    // Water stays in place: (1 - c) n.
    EXPECT_NEAR((1.0 - ahead.concentration[e]) * ahead.porosity[e], 0.95 * 0.3, 1e-15);
  }
}

}  // namespace rigid_skeleton_test
}  // namespace suffuse
