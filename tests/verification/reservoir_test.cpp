/// Reservoirs whose level follows from what seeps: a permeameter with a falling head, two
/// reservoirs that come to one level, and one that falls past the face of the soil.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "model_run.hpp"

namespace suffuse {
namespace reservoir_test {

constexpr double conductivity = 2e-2;

BoundaryCondition head_on(const std::string& name, double head, double reservoir_area = unset) {
  BoundaryCondition b;
  b.on = name;
  b.head = head;
  b.reservoir_area = reservoir_area;
  return b;
}

/// A column of 1 m by 1 m.
Scene column_scene(std::vector<BoundaryCondition> boundaries, double end) {
  Scene scene = model::paper_scene();
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.inertia = false;
  scene.time.end = end;
  scene.initial_flow = InitialFlow::steady;
  scene.boundaries = std::move(boundaries);
  return scene;
}

double level_of(model::ModelRun& run, int boundary) {
  return run.model().boundary_rows(run.model().flow_state())[boundary].level;
}

/// H' = -k H w / (L A), whose level is H0 exp(-k t / A) here.
double error_of_falling_head(double step) {
  constexpr double area = 0.2;
  Scene scene = column_scene({head_on("top", 3.0, area), head_on("bottom", 0.0)}, 20.0);
  if (step > 0.0) scene.time.step = step;
  model::ModelRun run(model::make_case(model::column_mesh(2, 4), scene));
  double worst = 0.0;
  for (const double time : {5.0, 10.0, 20.0}) {
    run.run({time});
    const double exact = 3.0 * std::exp(-conductivity * time / area);
    worst = std::max(worst, std::abs(level_of(run, 0) - exact) / 3.0);
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  return worst;
}

TEST(Reservoir, OfAPermeameterFallsAsExactly) {
  const double coarse = error_of_falling_head(0.5);
  const double fine = error_of_falling_head(0.25);
  const double chosen = error_of_falling_head(0.0);
  std::cout << "falling head: error " << coarse << " with steps of 0.5 s, " << fine
            << " with 0.25 s, " << chosen << " with steps by tolerance\n";
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
  EXPECT_LT(chosen, 2e-3);
}

TEST(Reservoir, TwoShareTheirWaterAndComeToOneLevel) {
  constexpr double small = 0.2;
  constexpr double large = 0.5;
  Scene scene = column_scene({head_on("top", 3.0, small), head_on("bottom", 1.5, large)}, 100.0);
  scene.gravity = {0.0, -9.81, 0.0};
  model::ModelRun run(model::make_case(model::column_mesh(2, 4), scene));
  for (const double time : {5.0, 10.0, 100.0}) {
    run.run({time});
    const double high = level_of(run, 0);
    const double low = level_of(run, 1);
    EXPECT_NEAR(small * high + large * low, small * 3.0 + large * 1.5, 1e-11) << time;
    const double exact = 1.5 * std::exp(-conductivity * time * (1.0 / small + 1.0 / large));
    EXPECT_NEAR(high - low, exact, 2e-3 * 1.5) << time;
  }
}

TEST(Reservoir, LosesWhatEntersTheSoilAlsoWhereItsLevelPassesTheSoil) {
  constexpr double area = 0.3;
  Scene scene = column_scene({head_on("left", 0.9, area), head_on("right", 0.1)}, 200.0);
  scene.gravity = {0.0, -9.81, 0.0};
  scene.soils[0].retention.law = retention_law("van-genuchten");
  scene.soils[0].retention.parameters.alpha = 3.0;
  scene.soils[0].retention.parameters.n = 2.0;
  model::ModelRun run(model::make_case(model::column_mesh(6, 6), scene));
  double last = 0.9;
  for (const double time : {1.0, 10.0, 50.0, 200.0}) {
    const auto moments = run.run({time});
    const BoundaryRow row = run.model().boundary_rows(moments.flows.back())[0];
    const double level = row.level;
    EXPECT_LT(level, last) << time;
    EXPECT_NEAR(area * (0.9 - level), row.liquid_in - row.liquid_out, 1e-11) << time;
    last = level;
  }
  EXPECT_LT(last, 0.3);
  EXPECT_LT(run.worst_residual(), 1e-12);
}

TEST(Reservoir, EmptiesWithoutRingingHoweverLongItsRun) {
  // It empties within seconds, and the run lasts for weeks.
  constexpr double area = 1e-3;
  Scene scene = column_scene({head_on("left", 0.9, area), head_on("right", 0.1)}, 2e6);
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = 0.1;
  scene.initial_flow = InitialFlow::rest;
  model::ModelRun run(model::make_case(model::column_mesh(6, 6), scene));
  const BoundaryRow row = run.model().boundary_rows(run.run({2e6}).flows.back())[0];
  EXPECT_NEAR(row.level, 0.1, 1e-6);
  EXPECT_NEAR(row.liquid_in, area * 0.8, 0.02 * area * 0.8);
  EXPECT_LT(row.liquid_out, 0.02 * area * 0.8);
}

}  // namespace reservoir_test
}  // namespace suffuse
