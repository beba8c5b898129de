/// Unsaturated flow against exact profiles: infiltration above a water table (Srivastava and Yeh
/// 1991, Gardner's soil) and horizontal absorption (Bruce and Klute 1956, van Genuchten's).

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <optional>

#include "model_run.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace infiltration_test {

constexpr double stiff = std::numeric_limits<double>::infinity();

Scene column_scene() {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::monotone;
  scene.liquid.bulk_modulus = stiff;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.soils[0].porosity = 0.4;
  scene.soils[0].skeleton_fraction = 0.6;
  scene.soils[0].conductivity = 1e-5;
  return scene;
}

/// Theta 0.06 to 0.40, K 1e-5, alpha 1; steady under 0.1 K, then 0.9 K.
Scene infiltration_scene() {
  Scene scene = column_scene();
  scene.soils[0].retention = model::gardner(1.0, 0.15);
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = 72000.0;
  BoundaryCondition top = model::flux_on("top", 0.0);
  top.darcy_flux = TimeFunction({{0.0, 1e-6}, {1e-9, 9e-6}});
  scene.boundaries = {top, model::pressure_on("bottom", 0.0)};
  return scene;
}

/// psi at heights every 1/25 m after `end` seconds; steps have the length `step`, if given.
std::vector<double> infiltrated(int cells, double end, TimeStepping stepping,
                                std::optional<double> step) {
  Scene scene = infiltration_scene();
  scene.time.stepping = stepping;
  scene.time.step = step;
  model::ModelRun run(model::make_case(model::column_mesh(1, cells, 1.0 / cells, 1.0), scene));
  const FlowState<2> flow = run.run({end}).flows.back();
  EXPECT_LT(run.worst_residual(), 1e-12);
  std::vector<double> psi;
  for (int i = 0; i <= 25; ++i) psi.push_back(flow.node_pressure[2 * i * (cells / 25)] / 9810.0);
  return psi;
}

double distance(const std::vector<double>& one, const std::vector<double>& other) {
  double largest = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    largest = std::max(largest, std::abs(one[i] - other[i]));
  }
  return largest;
}

/// Largest error against the exact profiles, relative to their range.
double error_of_infiltration(TimeStepping stepping, double tolerance) {
  const auto rows = read_reference("infiltration-gardner.csv");
  Scene scene = infiltration_scene();
  scene.time.stepping = stepping;
  scene.time.tolerance = tolerance;
  model::ModelRun run(model::make_case(model::column_mesh(1, 100, 0.01, 1.0), scene));
  double worst = 0.0;
  double lowest = 0.0;
  for (const double time : {1800.0, 3600.0, 7200.0, 14400.0, 36000.0, 72000.0}) {
    const FlowState<2> flow = run.run({time}).flows.back();
    for (const auto& row : rows) {
      if (row.number("t") != time) continue;
      const int node = 2 * static_cast<int>(std::lround(row.number("z") * 100));
      const double psi = flow.node_pressure[node] / 9810.0;
      worst = std::max(worst, std::abs(psi - row.number("psi")));
      lowest = std::min(lowest, row.number("psi"));
    }
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  std::cout << "tolerance " << tolerance << ": off by " << worst << " m of " << -lowest << " m, "
            << run.steps() << " steps\n";
  return worst / -lowest;
}

TEST(Infiltration, FollowsSrivastavaAndYeh) {
  EXPECT_LT(error_of_infiltration(TimeStepping::second_order, 1e-3), 0.01);
  const double coarse = error_of_infiltration(TimeStepping::monotone, 1e-3);
  const double fine = error_of_infiltration(TimeStepping::monotone, 2.5e-4);
  // Backward Euler's steps are proportional to the root of the tolerance, its errors to the steps.
  EXPECT_LT(fine, 0.01);
  EXPECT_LT(fine, 0.7 * coarse);
}

TEST(Infiltration, ConvergesInSpaceAndTime) {
  const auto monotone = TimeStepping::monotone;
  std::vector<std::vector<double>> fields;
  for (const int cells : {25, 50, 100, 200}) {
    fields.push_back(infiltrated(cells, 3600.0, monotone, 100.0));
  }
  const double in_space =
      std::log2(distance(fields[1], fields[2]) / distance(fields[2], fields[3]));
  EXPECT_GT(in_space, 1.5);
  std::cout << "order in space " << in_space << '\n';
  for (const auto& [stepping, order] :
       {std::pair{monotone, 0.9}, std::pair{TimeStepping::second_order, 1.7}}) {
    const auto fine = infiltrated(50, 3600.0, stepping, 5.0);
    const double coarse = distance(infiltrated(50, 3600.0, stepping, 120.0), fine);
    const double half = distance(infiltrated(50, 3600.0, stepping, 60.0), fine);
    std::cout << "order in time " << std::log2(coarse / half) << ", differences " << coarse << ", "
              << half << " m\n";
    EXPECT_GT(std::log2(coarse / half), order);
  }
}

/// u = q/K + (1 - q/K) exp(-alpha z), u = exp(alpha psi), under rain and where water evaporates.
TEST(SteadyProfile, AboveAWaterTableIsExact) {
  for (const double ratio : {0.5, 0.1, -0.05}) {
    std::vector<double> errors;
    for (const int cells : {10, 20, 40}) {
      Scene scene = infiltration_scene();
      scene.soils[0].retention = model::gardner(2.0, 0.15);
      scene.boundaries[0].darcy_flux = TimeFunction(ratio * 1e-5);
      model::ModelRun run(model::make_case(model::column_mesh(1, cells, 1.0 / cells, 1.0), scene));
      const FlowState<2> flow = run.model().flow_state();
      const Grid<2>& grid = run.model().grid();
      double worst = 0.0;
      for (int f = 0; f < grid.face_count(); ++f) {
        const double z = grid.face_centre(f)[1];
        const double exact = std::log(ratio + (1.0 - ratio) * std::exp(-2.0 * z)) / 2.0;
        worst = std::max(worst, std::abs(flow.face_pressure[f] / 9810.0 - exact));
      }
      errors.push_back(worst);
    }
    const double order = std::log2(errors[1] / errors[2]);
    std::cout << "q/K " << ratio << ": " << errors[0] << ", " << errors[1] << ", " << errors[2]
              << " m, order " << order << '\n';
    EXPECT_GT(order, 1.8);
    EXPECT_LT(errors[2], 2e-3);
  }
}

/// Rain on soil in a box without an outlet, with incompressible water: there is no steady flow, and
/// the pores take all the rain.
TEST(Infiltration, FillsTheSoilOfASealedBox) {
  Scene scene = column_scene();
  scene.soils[0].retention = model::gardner(1.0);
  scene.water_level = -2.0;
  scene.time.end = 7200.0;
  scene.boundaries = {model::flux_on("top", 1e-6)};
  model::ModelRun run(model::make_case(model::column_mesh(1, 10, 0.1, 1.0), scene));
  const auto moments = run.run({3600.0, 7200.0});
  const auto water = [&](int i) { return moments.states[i].ledger.water; };
  EXPECT_NEAR(water(1) - water(0), 1000.0 * 1e-6 * 0.1 * 3600.0, 1e-12);
  EXPECT_LT(run.worst_residual(), 1e-12);
}

TEST(Absorption, FollowsBruceAndKlute) {
  const auto rows = read_reference("absorption-van-genuchten.csv");
  for (const int cells : {50, 100, 200}) {
    Scene scene = column_scene();
    scene.gravity = {};
    scene.soils[0].retention = model::van_genuchten(3.0, 2.0, 0.15);
    const double psi_wet = -std::pow(std::pow(0.95, -2.0) - 1.0, 0.5) / 3.0;
    const double psi_dry = -std::pow(std::pow(0.30, -2.0) - 1.0, 0.5) / 3.0;
    scene.water_level = psi_dry;
    scene.time.end = 20000.0;
    scene.boundaries = {model::pressure_on("left", psi_wet * 9810.0)};
    model::ModelRun run(model::make_case(model::column_mesh(cells, 1, 1.0, 1.0 / cells), scene));
    const auto moments = run.run({20000.0});
    const FlowState<2>& flow = moments.flows.back();
    EXPECT_LT(run.worst_residual(), 1e-12);
    double worst = 0.0;
    for (const auto& row : rows) {
      const double x = row.number("phi") * std::sqrt(20000.0) * cells;
      if (x > cells - 1) continue;
      const int i = static_cast<int>(x);
      const auto effective = [&](int node) {
        const RetentionModel& soil = scene.soils[0].retention;
        return soil.law->at(soil.parameters, flow.node_pressure[node] / 9810.0).saturation;
      };
      const double found = std::lerp(effective(i), effective(i + 1), x - i);
      worst = std::max(worst, std::abs(found - row.number("S_e")));
    }
    double entered = 0.0;
    const LedgerRow ledger = run.model().ledger();
    entered = (ledger.water_in - ledger.water_out) / 1000.0 * cells;
    const double sorptivity_error = entered / std::sqrt(20000.0) / 4.75403e-4 - 1.0;
    std::cout << cells << " cells: " << worst << ", sorptivity " << sorptivity_error << ", "
              << run.steps() << " steps\n";
    EXPECT_LT(worst, 0.01);
    EXPECT_LT(std::abs(sorptivity_error), 0.75 / cells);
  }
}

TEST(Ponding, OfDrySand) {
  for (const int cells : {10, 50, 100}) {
    Scene scene = column_scene();
    scene.soils[0].retention = model::van_genuchten(14.5, 2.68, 0.10);
    scene.soils[0].conductivity = 8.25e-5;
    scene.water_level = -10.0;
    scene.time.end = 3600.0;
    scene.boundaries = {model::pressure_on("top", 981.0)};
    model::ModelRun run(model::make_case(model::column_mesh(1, cells, 1.0 / cells, 1.0), scene));
    double shortest = 3600.0;
    double time = 0.0;
    while (run.model().time() < 3600.0) {
      run.model().advance(3600.0);
      // The first steps are very short.
      if (time > 1e-3) shortest = std::min(shortest, run.model().last_step());
      time = run.model().time();
    }
    const auto steps = static_cast<double>(run.steps());
    double solved = 0.0;
    for (const auto& pass : run.model().passes()) {
      if (pass.name == "flow, systems solved") solved = static_cast<double>(pass.calls);
    }
    const double entered = run.model().ledger().water_in * cells / 1000.0;
    std::cout << cells << " cells: " << run.steps() << " steps, " << solved / steps
              << " systems solved a step, shortest " << shortest << " s, " << entered
              << " m entered\n";
    EXPECT_GT(shortest, 3600.0 * 1e-6);
    EXPECT_LT(solved / steps, 25.0);
    EXPECT_GT(entered, 0.1);
  }
}

/// Columns of Celia, Bouloutas and Zarba (1990), wetted from above and drained from below: in every
/// step the change of storage is the flow through the ends.
TEST(Celia, MassesBalanceAtEveryStep) {
  for (const bool wets : {true, false}) {
    for (const double step : {2400.0, 360.0, 20.0}) {
      Scene scene = column_scene();
      scene.soils[0].porosity = 0.368;
      scene.soils[0].skeleton_fraction = 0.632;
      scene.soils[0].conductivity = 9.22e-5;
      scene.soils[0].retention = model::van_genuchten(3.35, 2.0, 0.102 / 0.368);
      scene.time.end = 86400.0;
      scene.time.step = step;
      scene.water_level = wets ? -10.0 : 0.6;
      scene.boundaries = {
          model::pressure_on(wets ? "top" : "bottom", (wets ? -0.75 : -2.0) * 9810)};
      model::ModelRun run(model::make_case(model::column_mesh(1, 24, 0.04, 0.6), scene));
      double worst = 0.0;
      LedgerRow before = run.model().ledger();
      const double water = before.water;
      while (run.model().time() < 86400.0) {
        run.model().advance(86400.0);
        const LedgerRow now = run.model().ledger();
        const double stored = now.water - before.water;
        const double crossed =
            (now.water_in - before.water_in) - (now.water_out - before.water_out);
        worst = std::max(worst, std::abs(stored - crossed) / water);
        before = now;
      }
      const double change = before.water - water;
      const double crossed = before.water_in - before.water_out;
      std::cout << (wets ? "wetting" : "drying") << ", step " << step
                << " s: balance ratio - 1 = " << change / crossed - 1.0 << ", per step " << worst
                << '\n';
      EXPECT_GT(std::abs(change), 0.1 * water);
      EXPECT_NEAR(change / crossed, 1.0, 1e-12);
      EXPECT_LT(worst, 1e-12);
    }
  }
}

}  // namespace infiltration_test
}  // namespace suffuse
