/// The double-point formulation against the single-point one, a sealed box, pressure by either
/// integration, and threads.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <map>

#include "double_point_modes.hpp"
#include "exact_fines.hpp"

namespace suffuse {
namespace double_point_flow_test {

constexpr double flux = 0.012;

Scene column_scene(double end) {
  Scene scene = model::double_point_scene(flux, 1e-3);
  scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
  scene.time.end = end;
  return scene;
}

/// Results of a column at each of `times`.
struct History {
  std::vector<double> porosity;
  std::vector<double> eroded;
  std::vector<double> concentration_out;
  std::vector<double> turbidity_out;
};

template <class Run>
History history_of(Run run, const std::vector<double>& times) {
  History result;
  for (const double t : times) {
    const auto moments = run.run({t});
    const HistoryRow row = moments.states[0].history;
    result.porosity.push_back(row.porosity_mean);
    result.eroded.push_back(moments.states[0].ledger.eroded);
    result.concentration_out.push_back(row.concentration_out);
    result.turbidity_out.push_back(row.turbidity_out);
  }
  return result;
}

TEST(DoublePointAndSinglePoint, AgreeInTheSameColumn) {
  const std::vector<double> times = model::times_up_to(60.0, 4.0);
  const Mesh<2> mesh = model::column_mesh(4, 8, 0.5, 1.0);
  Scene scene = column_scene(times.back());
  const History two =
      history_of(model::DoublePointRun(model::make_double_point_case(mesh, scene)), times);
  scene.formulation = Formulation::single_point;
  const History one = history_of(model::ModelRun(model::make_case(mesh, scene)), times);
  double porosity = 0.0;
  double eroded = 0.0;
  double concentration = 0.0;
  double at_front = 0.0;
  double error = 0.0;
  double turbidity = 0.0;
  double largest = 0.0;
  const double grain_density = scene.soils.front().grain_density;
  const UniformFines exact([](double) { return 1e-3; }, 0.3, 0.4, 2.0, flux, times.back());
  for (std::size_t k = 0; k < times.size(); ++k) {
    porosity = std::max(porosity, std::abs(two.porosity[k] - one.porosity[k]));
    eroded = std::max(eroded, std::abs(two.eroded[k] - one.eroded[k]));
    const double expected = exact.concentration(1.0, times[k]);
    error = std::max(error, std::abs(two.concentration_out[k] - expected));
    turbidity = std::max(turbidity, std::abs(two.turbidity_out[k] - grain_density * expected));
    const double difference = std::abs(two.concentration_out[k] - one.concentration_out[k]);
    // The first water that entered after the start arrives at 28 s. A mesh that carries c smears
    // the kink of its arrival, but points do not.
    double& worst = times[k] == 28.0 ? at_front : concentration;
    worst = std::max(worst, difference);
    largest = std::max(largest, one.concentration_out[k]);
  }
  std::cout << "double-point minus single-point: porosity " << porosity << ", eroded mass "
            << eroded << " kg, c at the outlet " << 100.0 * concentration / largest
            << " % of its largest, " << 100.0 * at_front / largest
            << " % as the front arrives; double-point minus exact " << 100.0 * error / largest
            << " %\n";
  EXPECT_LE(porosity, 1e-12);
  EXPECT_LE(eroded, 1e-10 * one.eroded.back());
  EXPECT_LE(concentration, 0.01 * largest);
  EXPECT_LE(at_front, 0.03 * largest);
  EXPECT_LE(error, 0.005 * largest);
  EXPECT_LE(turbidity, 0.005 * largest * grain_density);
  EXPECT_GT(largest, 0.05);
}

TEST(DoublePointBox, ASealedBoxErodesWithoutPressure) {
  for (const auto integration : {PressureIntegration::mixed, PressureIntegration::material_point}) {
    Scene scene = column_scene(20.0);
    scene.boundaries.clear();
    scene.initial_flow = InitialFlow::rest;
    scene.flow.integration = integration;
    scene.time.mass_scaling = 1e2;
    model::DoublePointRun run(model::make_double_point_case(
        model::column_mesh(4, 4, 1.0, 1.0, model::jittered(0.05, 2)), scene));
    const auto moments = run.run({20.0});
    const HistoryRow row = moments.states[0].history;
    const LedgerRow ledger = moments.states[0].ledger;
    std::cout << "sealed box: pressure " << row.pressure_min << " to " << row.pressure_max
              << " Pa, speed " << row.speed_max << " m/s, fines " << ledger.fines << " kg\n";
    // With K = 2e7 Pa, a share of 1e-12 of the volume is 2e-5 Pa.
    EXPECT_LE(std::max(-row.pressure_min, row.pressure_max), 2e-5);
    EXPECT_LE(row.speed_max, 1e-9);
    EXPECT_NEAR(ledger.fines, 2700.0 * 18e-3, 1e-9);
    EXPECT_EQ(ledger.points, run.input().liquid_points.size());
    EXPECT_LE(run.worst_residual(), 1e-12);
  }
}

TEST(DoublePointThreads, OneAndTwoGiveTheSameBits) {
  const auto with_threads = [](int threads, PressureIntegration integration) {
    Scene scene = column_scene(4.0);
    scene.flow.integration = integration;
    scene.soils[0].erosion.start = 0.0;
    scene.time.mass_scaling = 1e4;
    // There are more points than the loops need to be parallel.
    SolverOptions options;
    options.threads = threads;
    model::DoublePointRun run(model::make_double_point_case(model::column_mesh(20, 20), scene),
                              options);
    run.run({4.0});
    EXPECT_GT(run.model().liquid().points().size(), 5000);
    return run.model().snapshot(run.model().flow_state());
  };
  for (const auto integration : {PressureIntegration::mixed, PressureIntegration::material_point}) {
    const Snapshot one = with_threads(1, integration);
    const Snapshot two = with_threads(2, integration);
    EXPECT_EQ(one.liquid_positions, two.liquid_positions);
    for (const auto& [a, b] : {std::pair{&one.cell, &two.cell}, std::pair{&one.node, &two.node},
                               std::pair{&one.element_vertex, &two.element_vertex},
                               std::pair{&one.liquid, &two.liquid}}) {
      ASSERT_EQ(a->size(), b->size());
      for (std::size_t k = 0; k < a->size(); ++k) EXPECT_EQ((*a)[k].values, (*b)[k].values);
    }
    EXPECT_GT(*std::max_element(one.liquid[0].values.begin(), one.liquid[0].values.end()), 0.0)
        << "there are grains in the liquid";
  }
}

TEST(DoublePointPressure, FallsInAStraightLineByEitherIntegration) {
  // rho_w g q / k per metre.
  const double slope = 1000.0 * 9.81 * flux / 0.02;
  for (const auto integration : {PressureIntegration::mixed, PressureIntegration::material_point}) {
    const bool mixed = integration == PressureIntegration::mixed;
    Scene scene = column_scene(10.0);
    scene.soils[0].erosion = {};
    scene.flow.integration = integration;
    scene.time.mass_scaling = 1e2;
    model::DoublePointRun run(model::make_double_point_case(model::column_mesh(4, 4), scene));
    const std::vector<double> times = model::times_up_to(10.0, 0.1);
    const auto moments = run.run(times);
    // Mean over the second half of the time, per row of cells, of the elements' pressures.
    const auto counted = static_cast<double>(times.size() - times.size() / 2);
    std::array<double, 4> mean{};
    double scatter = 0.0;
    for (std::size_t k = times.size() / 2; k < times.size(); ++k) {
      for (int e = 0; e < run.input().mesh.element_count(); ++e) {
        const int row = e / 8;
        mean[row] += moments.flows[k].pressure[e] / 8.0 / counted;
      }
      scatter = std::max(scatter, moments.states[k].history.pressure_scatter);
    }
    double worst = 0.0;
    for (int row = 0; row < 4; ++row) {
      // The mean over the row is the value at its middle.
      worst = std::max(worst, std::abs(mean[row] - slope * (0.125 + 0.25 * row)));
    }
    std::cout << (mixed ? "mixed" : "material-point") << ": mean pressure profile off by "
              << 100.0 * worst / slope << " % of the largest pressure, scatter "
              << 100.0 * scatter / slope << " %\n";
    EXPECT_LE(worst, 0.05 * slope);
  }
}

/// Water that carries the flow through soil that erodes, fast enough for a few steps per interval.
Case<2> carried_case() {
  Scene scene = model::double_point_scene(0.12, 5e-3);
  scene.boundaries[0].concentration = 0.02;
  scene.soils[0].erosion.start = 0.0;
  scene.flow.integration = PressureIntegration::material_point;
  scene.time.mass_scaling = 1e2;
  scene.time.end = 3.0;
  LayerSettings layers;
  layers.inflow = layers.outflow = layers.above = layers.below = 1;
  return model::make_double_point_case(model::layered_mesh(4, layers), scene);
}

TEST(DoublePointCarried, BooksCloseAtEveryOutput) {
  model::DoublePointRun seen(carried_case());
  const std::vector<double> times = model::times_up_to(3.0, 0.0043);
  const auto moments = seen.run(times);
  EXPECT_GE(seen.model().liquid().inflow().next_id, seen.input().liquid_points.size() + 400);

  double model_off = 0.0;
  double region_off = 0.0;
  double porosity_off = 0.0;
  double jump = 0.0;
  for (std::size_t k = 0; k < moments.states.size(); ++k) {
    const model::ModelState<DoublePoint>& state = moments.states[k];
    const auto worse = [](double& worst, const LedgerRow& row) {
      worst = std::max({worst, std::abs(row.residual_water), std::abs(row.residual_grains)});
    };
    worse(model_off, state.ledger);
    for (const RegionRow& row : state.regions) worse(region_off, row.ledger);
    const HistoryRow row = state.history;
    porosity_off = std::max(porosity_off, std::abs(row.porosity_mean - 0.3 - 5e-3 * state.time));
    if (k == 0) continue;
    const model::ModelState<DoublePoint>& before = moments.states[k - 1];
    std::map<long, Vector<2>> places;
    for (int p = 0; p < before.liquid.size(); ++p) {
      places[before.liquid.id[p]] = before.liquid.place(p).position(seen.input().mesh);
    }
    for (int p = 0; p < state.liquid.size(); ++p) {
      const auto found = places.find(state.liquid.id[p]);
      if (found == places.end()) continue;
      const Vector<2> x = state.liquid.place(p).position(seen.input().mesh);
      jump = std::max(jump, (x - found->second).norm() / (state.time - before.time));
    }
  }
  std::cout << times.size() << " outputs in " << seen.steps() << " steps: residual " << model_off
            << ", of regions " << region_off << ", porosity off by " << porosity_off
            << ", fastest point " << jump << " m/s\n";
  EXPECT_LE(model_off, 1e-12);
  EXPECT_LE(region_off, 1e-12);
  EXPECT_LE(porosity_off, 1e-13);
  EXPECT_LE(jump, 2.0 * 0.12 / 0.3);
}

}  // namespace double_point_flow_test
}  // namespace suffuse
