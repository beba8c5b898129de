/// Soil that moves in three dimensions: consolidation, and a bank that loses its fines, fails and
/// runs out, as slabs of tetrahedra.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "moving_space.hpp"
#include "physics/skeleton/soil_element.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace moving_space_test {

using model::clean_pressure_on;
using model::missing_fines;
using model::slab_of_bank;
using model::slab_scene;
using model::SpaceRun;

double pressure_at(SpaceRun& run, double z) {
  const Grid<3>& grid = run.model().grid();
  const FlowState<3> flow = run.model().flow_state();
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    if (std::abs(grid.mesh.nodes[i][2] - z) > 1e-9) continue;
    sum += flow.node_pressure[i];
    ++count;
  }
  return sum / count;
}

struct Deviation {
  double settlement = 0.0;
  double pressure = 0.0;
};

/// Largest differences from Terzaghi's solution from T = 0.1 on, relative to the final settlement
/// and the first pressure.
Deviation deviation_from_terzaghi(int rows) {
  constexpr double load = 1e3;
  constexpr double conductivity = 1e-6;
  const SkeletonModel soil = model::elastic_soil(1e7, 0.3);
  const double oedometer = soil.at(1.0).oedometer_modulus();
  const auto time_of = [&](double T) { return T * 9810.0 / (conductivity * oedometer); };
  Scene scene = slab_scene();
  scene.gravity = {0.0, 0.0, 0.0};
  scene.time.end = 2.0 * time_of(1.0);
  scene.time.tolerance = 2e-4;
  scene.soils[0].conductivity = conductivity;
  scene.soils[0].skeleton = soil;
  BoundaryCondition top = clean_pressure_on("top", 0.0);
  top.traction = VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {1e-9, {0.0, 0.0, -load}}}};
  scene.boundaries.push_back(top);
  const double size = 1.0 / rows;
  SpaceRun run(model::box_mesh({2, 2, rows}, {2.0 * size, 2.0 * size, 1.0}), scene);
  const double last = load / oedometer;
  Deviation worst;
  for (const ReferenceRow& row : read_reference("terzaghi.csv")) {
    const double T = row.number("T");
    if (T < 0.1 || T > 1.0) continue;
    run.run_to(time_of(T));
    double height = 0.0;  // of the highest point at the start
    double sunk = 0.0;
    const Snapshot snapshot = run.snapshot();
    const std::vector<double>& at = snapshot.solid_positions;
    const auto start = std::ranges::find(snapshot.solid, "displacement", &Field::name);
    for (std::size_t p = 0; p < at.size(); p += 3) {
      const double before = at[p + 2] - start->values[p + 2];
      if (before <= height) continue;
      height = before;
      sunk = -start->values[p + 2];
    }
    // The soil above it drains, and has its final strain.
    const double settlement = sunk + last * (1.0 - height);
    worst.settlement = std::max(worst.settlement, std::abs(settlement / last - row.number("U")));
    for (const double depth : {0.25, 0.5, 0.75}) {
      std::ostringstream name;
      name << "u(" << depth << ")";
      const double exact = load * row.number(name.str());
      worst.pressure =
          std::max(worst.pressure, std::abs(pressure_at(run, 1.0 - depth) - exact) / load);
    }
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  std::cout << rows << " rows: settlement off by " << worst.settlement << ", pressure by "
            << worst.pressure << "\n";
  return worst;
}

TEST(SpaceConsolidation, FollowsTerzaghi) {
  const Deviation coarse = deviation_from_terzaghi(4);
  const Deviation fine = deviation_from_terzaghi(8);
  EXPECT_LT(fine.settlement, 0.01);
  EXPECT_LT(fine.pressure, 0.01);
  EXPECT_LT(fine.settlement, 0.4 * coarse.settlement);
  EXPECT_LT(fine.pressure, 0.4 * coarse.pressure);
}

/// In the plane elements of 0.25 m fail at 7.4 to 8.3 s, as they are arranged, and of 0.125 m
/// at 7.2 to 7.5 s.
TEST(SpaceBank, LosesItsFinesFailsAndRunsOutUnderWater) {
  SpaceRun run = slab_of_bank();
  const LedgerRow start = run.model().ledger();
  run.run_to(7.0);
  EXPECT_EQ(run.history().failure_time, 0.0);
  EXPECT_LT(run.history().displacement_max, 0.03);
  run.run_to(9.5);
  const HistoryRow now = run.history();
  const LedgerRow ledger = run.model().ledger();
  std::cout << "failed at " << now.failure_time << " s, moved by " << now.displacement_max
            << " m at 9.5 s, inertia " << now.inertia << ", " << run.model().steps() << " steps\n";
  EXPECT_GT(now.failure_time, 7.5);
  EXPECT_LT(now.failure_time, 9.0);
  EXPECT_GT(now.inertia, 1e-3);
  EXPECT_GT(now.displacement_max, 0.1);
  EXPECT_LT(run.worst_residual(), 1e-12);
  EXPECT_NEAR(missing_fines(ledger, start.erodible), 0.0, 1e-12 * start.erodible);
  EXPECT_NEAR(ledger.solid + ledger.eroded, start.solid, 1e-12 * start.solid);
}

/// A run that is stored while soil slides resumes with the same bits, on another number of threads.
TEST(SpaceBank, GoesOnFromWithinItsSlide) {
  constexpr double within = 9.3;
  constexpr double later = 9.4;
  SpaceRun one = slab_of_bank();
  one.run_to(within);
  ASSERT_TRUE(one.model().solid().has_inertia());
  StateArchive kept;
  one.model().archive(kept);
  one.run_to(later);
  SpaceRun resumed = slab_of_bank(2);
  StateArchive given(kept.finish());
  resumed.model().archive(given);
  resumed.run_to(later);
  const Snapshot a = one.snapshot();
  const Snapshot b = resumed.snapshot();
  EXPECT_EQ(a.solid_positions, b.solid_positions);
  for (std::size_t k = 0; k < a.cell.size(); ++k) EXPECT_EQ(a.cell[k].values, b.cell[k].values);
  for (std::size_t k = 0; k < a.solid.size(); ++k) EXPECT_EQ(a.solid[k].values, b.solid[k].values);
}

}  // namespace moving_space_test
}  // namespace suffuse
