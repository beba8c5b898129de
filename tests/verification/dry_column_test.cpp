/// Dry sand that has no equilibrium at the start: a column whose gate is removed collapses in a
/// whole run. Its pores hold almost no liquid.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "moving_soil.hpp"

namespace suffuse {
namespace dry_column_test {

using model::fixed_on;

constexpr int few_cells = 8;   // per width of the column, which is 1 m
constexpr double reach = 3.5;  // m

/// Sand of 31 degrees without cohesion where `is_sand` holds, under a liquid as light as air.
model::ModelRun sand(int cells, double height, double cell_height,
                     const std::function<bool(const Vector<2>&)>& is_sand,
                     AtFailure failure = AtFailure::follow) {
  Mesh<2> mesh =
      model::crossed_mesh(static_cast<int>(reach * cells),
                          static_cast<int>(std::lround(height / cell_height)), reach, height);
  mesh.region_names = {"specimen", "free_above"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = is_sand(element_centroid(mesh, e)) ? 0 : 1;
  }
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, -9.81, 0.0};
  scene.liquid = {.density = 1.0, .bulk_modulus = std::numeric_limits<double>::infinity()};
  scene.water_level = height;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = 10.0;
  scene.time.failure = failure;
  scene.boundaries = {fixed_on("left", Fixing::normal), fixed_on("right", Fixing::normal),
                      fixed_on("bottom", Fixing::both), model::clean_pressure_on("top", 0.0)};
  Soil& soil = scene.soils[0];
  soil.conductivity = 1.0;
  soil.erosion = {};
  soil.skeleton = model::elastic_soil(1e6, 0.3);
  soil.skeleton.law = skeleton_law("mohr-coulomb");
  soil.skeleton.friction = 31.0;
  return model::ModelRun(model::make_case(std::move(mesh), scene));
}

std::function<bool(const Vector<2>&)> column(double aspect) {
  return [aspect](const Vector<2>& x) { return x[0] < 1.0 && x[1] < aspect; };
}

struct Shape {
  double runout = 0.0;  ///< of the farthest point except 2 % of them, m
  double height = 0.0;  ///< mean height of the points, m
};

Shape shape_of(const Snapshot& snapshot) {
  std::vector<double> x;
  Shape result;
  for (std::size_t p = 0; p < snapshot.solid_positions.size(); p += 3) {
    x.push_back(snapshot.solid_positions[p]);
    result.height += snapshot.solid_positions[p + 1];
  }
  result.height /= static_cast<double>(x.size());
  std::ranges::sort(x);
  result.runout = x[static_cast<std::size_t>(0.98 * static_cast<double>(x.size()))] - 1.0;
  return result;
}

/// Lube, Huppert, Sparks and Freundt (Phys. Rev. E 72 (2005) 041301): 1.2 a for a below 1.8. The
/// mesh is coarse: in a low column only a few rows flow. From 8 to 16 cells the share grows from
/// 0.80 to 0.91 for a = 1 and from 0.54 to 0.66 for a = 0.5.
double runout_over_that_of_sand(double aspect, int cells) {
  model::ModelRun run = sand(cells, aspect + 0.25, 1.0 / cells, column(aspect));
  EXPECT_TRUE(run.model().solid().has_inertia());
  const double solid = run.model().ledger().solid;
  std::vector<double> times;
  for (int i = 1; i <= 20; ++i) times.push_back(0.05 * i);
  const auto moments = run.run(times, true);
  Shape before = {0.0, 0.5 * aspect};
  for (const Snapshot& snapshot : moments.snapshots) {
    const Shape now = shape_of(snapshot);
    // The fall supplies the energy: no front is faster than a free fall from the top.
    EXPECT_LE(now.height, before.height + 1e-4 * aspect);
    EXPECT_LE(now.runout - before.runout, 0.05 * std::sqrt(2.0 * 9.81 * aspect));
    before = now;
  }
  const auto end = run.run({6.0}, true);
  const Shape last = shape_of(end.snapshots.back());
  const auto& row = end.states.back().history;
  std::cout << "a " << aspect << ": run-out " << last.runout << " m, mean height " << last.height
            << " m, inertia " << row.inertia << ", failed last at " << row.failure_time << " s, "
            << run.steps() << " steps\n";
  EXPECT_LT(row.inertia, 1e-2);
  EXPECT_NEAR(last.runout, before.runout, 0.5);
  EXPECT_LT(run.worst_residual(), 1e-12);
  EXPECT_NEAR(end.states.back().ledger.solid, solid, 1e-12 * solid);
  return last.runout / (1.2 * aspect);
}

TEST(DryColumn, CollapsesFromTheStartAndRunsOutAboutAsFarAsSand) {
  EXPECT_NEAR(runout_over_that_of_sand(1.0, 16), 1.0, 0.2);
  EXPECT_NEAR(runout_over_that_of_sand(0.5, few_cells), 1.0, 0.5);
}

TEST(DryColumn, IsRefusedWhereTheRunIsToStop) {
  EXPECT_THROW(sand(few_cells, 1.25, 1.0 / few_cells, column(1.0), AtFailure::stop),
               NumericalError);
}

/// A slope of 26.6 degrees along the diagonals of cells twice as wide as high.
TEST(DryBank, StandsWhereItIsLessSteepThanItsFriction) {
  const auto bank = [](const Vector<2>& x) { return 0.5 * x[0] + x[1] < 1.0; };
  model::ModelRun run = sand(few_cells, 1.25, 0.5 / few_cells, bank);
  EXPECT_FALSE(run.model().solid().has_inertia());
  const auto states = run.run({1.0}).states;
  EXPECT_EQ(states.back().history.failure_time, 0.0);
  EXPECT_LT(states.back().history.displacement_max, 1e-3);
}

}  // namespace dry_column_test
}  // namespace suffuse
