/// Soil under free water and under air, and a bank that loses its fines, fails and runs out.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "moving_soil.hpp"

namespace suffuse {
namespace failing_soil_test {

using model::clean_pressure_on;
using model::fixed_on;
using model::missing_fines;
using model::under_water;

Scene basin(double water_level) {
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = water_level;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.boundaries = {fixed_on("left", Fixing::normal), fixed_on("right", Fixing::normal),
                      fixed_on("bottom", Fixing::both), clean_pressure_on("top", 0.0)};
  return scene;
}

/// sigma'_v = -(1 - n)(rho_s - rho_w) g z, z below the surface of the soil. Returns the largest
/// error, relative to the largest stress.
double submerged_stress_error(int rows) {
  constexpr double surface = 0.5;
  Scene scene = basin(1.0);
  scene.time.end = 1.0;
  scene.soils[0].skeleton = model::elastic_soil(1e8, 0.0);
  model::ModelRun run(
      model::make_case(under_water(model::crossed_mesh(2, rows, 2.0 / rows, 1.0),
                                   [](const Vector<2>& x) { return x[1] < surface; }),
                       scene));
  const auto moments = run.run({1.0}, true);
  const Snapshot& snapshot = moments.snapshots.back();
  const auto stress = std::ranges::find(snapshot.solid, "effective_stress", &Field::name);
  const double weight = (1.0 - 0.3) * (2700.0 - 1000.0) * 9.81;
  double error = 0.0;
  for (std::size_t p = 0; p < snapshot.solid_positions.size() / 3; ++p) {
    const double exact = -weight * (surface - snapshot.solid_positions[3 * p + 1]);
    error = std::max(error, std::abs(stress->values[4 * p + 1] - exact) / (weight * surface));
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  return error;
}

/// Stress is constant in an element: its error is proportional to the size of elements.
TEST(FreeWater, PressesOnTheSoilBelowIt) {
  double last = 0.0;
  for (const int rows : {8, 16, 32}) {
    const double error = submerged_stress_error(rows);
    std::cout << rows << " rows: stress off by " << error << "\n";
    EXPECT_LT(error, 1.0 / rows);
    if (last > 0.0) {
      EXPECT_GT(std::log2(last / error), 0.9);
    }
    last = error;
  }
}

/// Gardner's soil over a water table at its base, under air: the stress follows from the weight of
/// soil and its water, and from suction times the effective saturation. Returns the largest error
/// of sigma', relative to the largest stress.
double stress_error_under_air(int rows) {
  constexpr double surface = 0.5;
  constexpr double alpha = 3.0;
  constexpr double residual = 0.1;
  Scene scene = basin(0.0);
  scene.boundaries.back() = fixed_on("top", Fixing::none);
  scene.boundaries[2].head = TimeFunction(0.0);
  scene.boundaries[2].concentration = TimeFunction(0.0);
  scene.time.end = 1.0;
  scene.soils[0].skeleton = model::elastic_soil(1e8, 0.0);
  scene.soils[0].retention = model::gardner(alpha, residual);
  model::ModelRun run(
      model::make_case(under_water(model::crossed_mesh(2, rows, 2.0 / rows, 1.0),
                                   [](const Vector<2>& x) { return x[1] < surface; }),
                       scene));
  const auto moments = run.run({1.0}, true);
  const Snapshot& snapshot = moments.snapshots.back();
  const auto stress = std::ranges::find(snapshot.solid, "effective_stress", &Field::name);
  const auto exact_at = [&](double y) {
    const double water =
        residual * (surface - y) +
        (1.0 - residual) / alpha * (std::exp(-alpha * y) - std::exp(-alpha * surface));
    const double weight = 0.7 * 2700.0 * 9.81 * (surface - y) + 0.3 * 1000.0 * 9.81 * water;
    return -weight - std::exp(-alpha * y) * 1000.0 * 9.81 * y;
  };
  double error = 0.0;
  for (std::size_t p = 0; p < snapshot.solid_positions.size() / 3; ++p) {
    const double y = snapshot.solid_positions[3 * p + 1];
    if (y > 0.35) continue;  // elements at the surface are a mixture of soil and free space
    const double exact = exact_at(y);
    error = std::max(error, std::abs(stress->values[4 * p + 1] - exact) / -exact_at(0.0));
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  return error;
}

TEST(Air, LeavesTheSoilBelowItItsWeightAndItsSuction) {
  double last = 0.0;
  for (const int rows : {8, 16, 32}) {
    const double error = stress_error_under_air(rows);
    std::cout << rows << " rows: stress off by " << error << "\n";
    EXPECT_LT(error, 1.0 / rows);
    if (last > 0.0) {
      EXPECT_GT(std::log2(last / error), 0.8);
    }
    last = error;
  }
}

/// Water that rises out of soil brings fines into the air. Heavy drops next to light ones would
/// drive it in circles there, in a new way in each step: only fines in soil weigh.
TEST(Air, IsNotStirredByFines) {
  constexpr double surface = 0.5;
  Scene scene = basin(0.4);
  scene.boundaries.back() = fixed_on("top", Fixing::none);
  scene.boundaries[2].head = TimeFunction(0.7);
  scene.boundaries[2].concentration = TimeFunction(0.0);
  scene.soils[0].skeleton = model::elastic_soil(1e8, 0.0);
  scene.soils[0].retention = model::van_genuchten(3.0, 2.5);
  scene.soils[0].conductivity = 1e-3;
  scene.soils[0].erosion.law = erosion_law("constant");
  scene.soils[0].erosion.rate = 1e-4;
  scene.time.end = 600.0;
  model::ModelRun run(
      model::make_case(under_water(model::crossed_mesh(2, 8, 0.125, 1.0),
                                   [](const Vector<2>& x) { return x[1] < surface; }),
                       scene));
  const auto moments = run.run({600.0}, true);
  const Field& concentration =
      *std::ranges::find(moments.snapshots.back().cell, "concentration", &Field::name);
  const Mesh<2>& mesh = run.input().mesh;
  const std::vector<double>& density = run.model().flow().coefficients().mixture_density;
  double richest_air = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (element_centroid(mesh, e)[1] < surface) {
      EXPECT_GT(density[e], scene.liquid.density);
    } else {
      EXPECT_EQ(density[e], scene.liquid.density);
      richest_air = std::max(richest_air, concentration.values[e]);
    }
  }
  EXPECT_GT(richest_air, 1e-3);
}

/// A bank of 1 m with a slope of 45 degrees that loses strength with its fines.
Scene bank() {
  Scene scene = basin(1.25);
  scene.initial_flow = InitialFlow::steady;
  Soil& soil = scene.soils[0];
  soil.conductivity = 1e-2;
  soil.skeleton = model::elastic_soil(2e6, 0.3);
  soil.skeleton.law = skeleton_law("mohr-coulomb");
  soil.skeleton.friction = FinesFunction({{1.0, 33.0}, {0.0, 25.0}});
  soil.skeleton.cohesion = FinesFunction({{1.0, 1.5e3}, {0.0, 0.0}});
  soil.erosion.law = erosion_law("constant");
  soil.erosion.rate = 0.01;
  return scene;
}

template <class Run = model::ModelRun>
Run bank_run(Scene scene, int threads = 1) {
  const auto is_soil = [](const Vector<2>& x) {
    return x[1] < 0.25 || (x[1] < 1.0 && x[0] + x[1] < 2.0);
  };
  SolverOptions options;
  options.threads = threads;
  scene.formulation = Run::formulation;
  return Run(model::make_case(under_water(model::crossed_mesh(16, 5, 4.0, 1.25), is_soil), scene),
             options);
}

/// Displacement that 95 % of the points stay below, m. That of a single point is chaotic: the
/// farthest one moves by 0.60 to 0.80 m as tolerances or the processor change.
double displacement_of_most(const Snapshot& snapshot) {
  const auto field = std::ranges::find(snapshot.solid, "displacement", &Field::name);
  std::vector<double> length;
  for (std::size_t i = 0; i < field->values.size(); i += 3) {
    length.push_back(std::hypot(field->values[i], field->values[i + 1]));
  }
  std::ranges::sort(length);
  return length[length.size() * 95 / 100];
}

/// Failure and run-out of the bank.
struct RunOut {
  double time = 0.0;          ///< of failure, s
  double displacement = 0.0;  ///< of most points, m
};

template <class Run>
RunOut fails_and_runs_out_under_water() {
  Scene scene = bank();
  scene.time.end = 12.0;
  scene.time.failure = AtFailure::follow;
  Run run = bank_run<Run>(scene);
  const double erodible = run.model().ledger().erodible;
  const double solid = run.model().ledger().solid;
  const auto states = run.run({7.0, 11.0}).states;
  EXPECT_EQ(states[0].history.failure_time, 0.0);
  EXPECT_EQ(states[0].history.inertia, 0.0);
  EXPECT_LT(states[0].history.displacement_max, 0.03);
  const auto& now = states[1];
  const double moved = displacement_of_most(run.model().snapshot(run.model().flow_state()));
  std::cout << "most points moved by less than " << moved << " m; failed at "
            << now.history.failure_time << " s, moved by " << now.history.displacement_max
            << " m at " << now.time << " s, inertia " << now.history.inertia << ", " << run.steps()
            << " steps\n";
  // The speed criterion starts inertia a little before equilibrium is lost, which is at 8.1 s.
  EXPECT_GT(now.history.failure_time, 7.5);
  // All fines are gone after 10 s; sand of 25 degrees is unstable at 45 degrees.
  EXPECT_LT(now.history.failure_time, 10.0);
  EXPECT_GT(now.history.inertia, 1e-3);
  EXPECT_GT(now.history.displacement_max, 0.4);
  EXPECT_LT(run.worst_residual(), 1e-12);
  EXPECT_NEAR(missing_fines(now.ledger, erodible), 0.0, 1e-12 * erodible);
  EXPECT_NEAR(now.ledger.solid + now.ledger.eroded, solid, 1e-12 * solid);
  return {now.history.failure_time, moved};
}

/// No reference is known: the distances are those of this method. They scatter, as single points
/// decide how the toe moves: other tolerances of the iteration give 0.41 to 0.43 m, and 0.37 to
/// 0.49 m in double-point.
TEST(Bank, LosesItsFinesFailsAndRunsOutUnderWater) {
  const RunOut one = fails_and_runs_out_under_water<model::ModelRun>();
  const RunOut both = fails_and_runs_out_under_water<model::DoublePointRun>();
  EXPECT_NEAR(both.time, one.time, 0.1);
  EXPECT_NEAR(one.displacement, 0.42, 0.05);
  EXPECT_NEAR(both.displacement, 0.42, 0.05);
}

/// Sand over a water table that loses strength, and slides into air.
Scene bank_in_air() {
  Scene scene = bank();
  scene.water_level = 0.1;
  scene.boundaries.back() = fixed_on("top", Fixing::none);
  Soil& soil = scene.soils[0];
  soil.conductivity = 1e-3;
  soil.retention = model::van_genuchten(3.0, 2.5);
  soil.skeleton.friction = FinesFunction({{1.0, 35.0}, {0.97, 16.0}, {0.0, 16.0}});
  soil.skeleton.cohesion = FinesFunction({{1.0, 3e3}, {0.97, 0.0}, {0.0, 0.0}});
  soil.erosion.rate = 1e-3;
  scene.time.end = 12.0;
  return scene;
}

/// Nothing is lost, and no element is drained below a pressure of -1e5 Pa.
TEST(Bank, SlidesIntoAir) {
  const Scene scene = bank_in_air();
  model::ModelRun run = bank_run(scene);
  const LedgerRow start = run.model().ledger();
  const auto states = run.run({2.0, 12.0}).states;
  EXPECT_LT(states[0].history.displacement_max, 1e-3);
  const auto& now = states[1];
  std::cout << "failed at " << now.history.failure_time << " s, moved by "
            << now.history.displacement_max << " m at " << now.time << " s, " << run.steps()
            << " steps, pressures from " << now.history.pressure_min << " Pa\n";
  EXPECT_GT(now.history.displacement_max, 0.1);
  EXPECT_GT(now.history.failure_time, 0.0);
  EXPECT_GT(now.history.pressure_min, -1e5);
  EXPECT_LT(run.worst_residual(), 1e-12);
  EXPECT_NEAR(missing_fines(now.ledger, start.erodible), 0.0, 1e-12 * start.erodible);
  EXPECT_NEAR(now.ledger.solid + now.ledger.eroded, start.solid, 1e-12 * start.solid);
}

/// If its friction falls to 25 degrees only, this bank of coarse elements finds an equilibrium with
/// a flatter slope. It falls to 15 degrees here.
TEST(Bank, EndsInItsLastEquilibriumWhereTheSceneSaysSo) {
  Scene scene = bank();
  scene.soils[0].skeleton.friction = FinesFunction({{1.0, 33.0}, {0.0, 15.0}});
  scene.time.end = 12.0;
  scene.time.failure = AtFailure::stop;
  model::ModelRun run = bank_run(scene);
  EXPECT_THROW(run.run({12.0}), EquilibriumLost);
  const HistoryRow row = run.state().history;
  EXPECT_EQ(row.failure_time, 0.0);
  EXPECT_EQ(row.inertia, 0.0);
  std::cout << "last equilibrium at " << run.model().time() << " s\n";
  EXPECT_GT(run.model().time(), 8.0);
}

/// A run that is stored while soil slides resumes with the same bits, on another number of threads.
TEST(Bank, GoesOnFromWithinItsSlide) {
  Scene scene = bank();
  scene.time.end = 12.0;
  constexpr double within = 9.4;
  constexpr double later = 9.6;
  model::ModelRun one = bank_run(scene);
  one.run({within, later});
  model::ModelRun two = bank_run(scene, 2);
  two.run({within});
  ASSERT_TRUE(two.model().solid().has_inertia());
  StateArchive kept;
  two.model().archive(kept);
  model::ModelRun resumed = bank_run(scene, 2);
  StateArchive given(kept.finish());
  resumed.model().archive(given);
  EXPECT_TRUE(resumed.model().solid().has_inertia());
  resumed.run({later});
  const Snapshot a = one.model().snapshot(one.model().flow_state());
  const Snapshot b = resumed.model().snapshot(resumed.model().flow_state());
  EXPECT_EQ(a.solid_positions, b.solid_positions);
  for (const auto& [x, y] : {std::pair{&a.cell, &b.cell}, std::pair{&a.solid, &b.solid}}) {
    for (std::size_t k = 0; k < x->size(); ++k) EXPECT_EQ((*x)[k].values, (*y)[k].values);
  }
}

}  // namespace failing_soil_test
}  // namespace suffuse
