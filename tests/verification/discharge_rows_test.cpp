/// Rows of a run with mesh.error: bounds while the flow is steady and saturated, otherwise an
/// estimate.

#include <gtest/gtest.h>

#include <cmath>

#include "model_run.hpp"

namespace suffuse {
namespace discharge_rows_test {

BoundaryCondition head_on(const std::string& name, double head) {
  BoundaryCondition b;
  b.on = name;
  b.head = head;
  return b;
}

/// A square with water on the middle of its top, that seeps out at the bottom.
Case<2> pond(Scene scene) {
  Mesh<2> mesh = model::column_mesh(8, 8);
  BoundarySet<2> pond{"pond", {}};
  for (const auto& face : mesh.boundaries[0].faces) {
    const double x = 0.5 * (mesh.nodes[face[0]][0] + mesh.nodes[face[1]][0]);
    if (std::abs(x - 0.5) < 0.25) pond.faces.push_back(face);
  }
  mesh.boundaries.push_back(pond);
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.inertia = false;
  scene.time.end = 1e4;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.soils[0].conductivity = 1e-5;
  scene.mesh.error = 0.1;
  scene.boundaries = {head_on("pond", 1.2), head_on("bottom", 0.4)};
  return model::make_case(std::move(mesh), std::move(scene));
}

/// Steady flow through soil that erodes and then conducts better.
Scene eroding_scene() {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::steady;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils[0].erosion.law = erosion_law("first-order");
  scene.soils[0].erosion.rate = 1e-3;
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  return scene;
}

TEST(DischargeRows, HaveBoundsOfASteadyFlow) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::steady;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  model::ModelRun run(pond(scene));
  for (const double time : {1.0, 1e4}) {
    const HistoryRow row = run.run({time}).states[0].history;
    EXPECT_EQ(row.flux_out_estimate, 0.0);
    EXPECT_NEAR(row.flux_out_low, row.flux_out, 1e-9 * row.flux_out);
    EXPECT_GT(row.flux_out_high, 1.01 * row.flux_out);
    EXPECT_LT(row.flux_out_high, 1.5 * row.flux_out);
    const BoundaryRow bottom = run.model().boundary_rows(run.model().flow_state())[1];
    EXPECT_NEAR(bottom.discharge_low, row.flux_out_low, 1e-12 * row.flux_out);
    EXPECT_NEAR(bottom.discharge_high, row.flux_out_high, 1e-12 * row.flux_out);
    EXPECT_EQ(bottom.discharge_estimate, 0.0);
  }
}

TEST(DischargeRows, HaveAnEstimateWhileSoilFills) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::rest;
  scene.water_level = 0.4;
  scene.liquid.bulk_modulus = 1e5;
  model::ModelRun run(pond(scene));
  const HistoryRow row = run.run({1e3}).states[0].history;
  EXPECT_EQ(row.flux_out_high, 0.0);
  EXPECT_GT(row.flux_out_estimate, 1e-3 * row.flux_out);
  EXPECT_LT(row.flux_out_estimate, row.flux_out);
}

/// With one head, the discharge of a flow that changes follows from the water that is stored, which
/// no dual sees.
TEST(DischargeRows, HaveNoEstimateByBalanceWhileWaterIsStored) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::rest;
  scene.water_level = 1.6;
  scene.liquid.bulk_modulus = 1e5;
  Case<2> c = pond(scene);
  c.document.scene.boundaries.pop_back();
  model::ModelRun run(std::move(c));
  const HistoryRow row = run.run({1.0}).states[0].history;
  EXPECT_GT(row.flux_out, 0.0);
  EXPECT_EQ(row.flux_out_high, 0.0);
  EXPECT_EQ(row.flux_out_estimate, 0.0);
  EXPECT_FALSE(run.model().flow_state().bounds->least_known);
}

/// Fluxes are those of the middle of a step, conductivities those of its end.
TEST(DischargeRows, HaveAnEstimateOnceErosionChangesTheConductivity) {
  model::ModelRun run(pond(eroding_scene()));
  EXPECT_GT(run.state().history.flux_out_high, 0.0) << "at the start";
  const HistoryRow row = run.run({100.0}).states[0].history;
  EXPECT_EQ(row.flux_out_high, 0.0);
  EXPECT_GT(row.flux_out_estimate, 0.0);
}

TEST(DischargeRows, HaveAnEstimateInUnsaturatedSoil) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::steady;
  scene.soils[0].retention = model::van_genuchten(3.0, 2.0);
  model::ModelRun run(pond(scene));
  const HistoryRow row = run.state().history;
  EXPECT_EQ(row.flux_out_high, 0.0);
  EXPECT_GT(row.flux_out_estimate, 0.01 * row.flux_out);
  EXPECT_LT(row.flux_out_estimate, row.flux_out);
}

/// The pond with a probe in the middle.
Case<2> observed_pond(Scene scene, double tolerance) {
  scene.time.tolerance = tolerance;
  scene.time.end = 3e4;
  scene.output.probes = {{.at = {0.5, 0.6, 0.0}, .disc = 0.2}};
  return pond(std::move(scene));
}

struct Seen {
  HistoryRow history;
  ProbeRow probe;
};

Seen seen_at(Case<2> c, double time) {
  model::ModelRun run(std::move(c));
  Seen seen{run.run({time}).states[0].history, {}};
  seen.probe = run.model().probe_rows(run.model().flow_state())[0];
  return seen;
}

TEST(DischargeRows, HaveMeansAndEstimatesAtProbes) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::steady;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  const ProbeRow probe = seen_at(observed_pond(scene, 1e-3), 1.0).probe;
  EXPECT_EQ(probe.disc, 0.2);
  EXPECT_NEAR(probe.head_mean, probe.head, probe.head_mean_estimate + 0.01);
  EXPECT_GT(probe.head_mean_estimate, 0.0);
  EXPECT_GT(probe.gradient, 0.3);
  EXPECT_LT(probe.gradient_estimate, 0.2 * probe.gradient);
  EXPECT_LT(probe.head_mean_time_estimate, 1e-15) << "a steady flow";
  EXPECT_EQ(probe.gradient_transport_estimate, 0.0) << "nothing is transported";
}

/// While soil fills, the head is far from that of the steady flow. The mean is that of the moment.
TEST(DischargeRows, HaveMeansOfAFlowThatStoresWater) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::rest;
  scene.water_level = 0.4;
  scene.liquid.bulk_modulus = 2e5;
  const ProbeRow early = seen_at(observed_pond(scene, 1e-3), 100.0).probe;
  const ProbeRow late = seen_at(observed_pond(scene, 1e-3), 3e4).probe;
  EXPECT_LT(early.head, late.head - 0.25);
  // The head is curved within the disc, by less than a third of what it has to rise.
  EXPECT_NEAR(early.head_mean, early.head, 0.08);
  EXPECT_NEAR(late.head_mean, late.head, 0.02);
  EXPECT_LT(early.head_mean_estimate, 0.05);
}

/// The level of the pond rises. Against steps a thousand times more accurate, numbers are off by
/// what several steps add up to.
TEST(DischargeRows, HaveEstimatesOfTheLastStepInTime) {
  constexpr double steps_that_add_up = 30.0;
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::steady;
  scene.liquid.bulk_modulus = 1e5;
  const auto rising = [&](double tolerance) {
    Case<2> c = observed_pond(scene, tolerance);
    c.document.scene.boundaries[0].head = TimeFunction({{0.0, 1.2}, {3e4, 1.6}});
    return seen_at(std::move(c), 2e4);
  };
  const Seen exact = rising(1e-6);
  for (const double tolerance : {1e-2, 1e-3}) {
    const Seen found = rising(tolerance);
    const auto check = [&](double value, double of_exact, double estimate) {
      EXPECT_GT(estimate, 0.0);
      EXPECT_LT(estimate, tolerance * std::abs(value));
      EXPECT_LT(std::abs(value - of_exact), steps_that_add_up * estimate) << tolerance;
    };
    EXPECT_NEAR(found.probe.head_mean, found.probe.head, 0.03) << "not that of the steady flow";
    check(found.probe.head_mean, exact.probe.head_mean, found.probe.head_mean_time_estimate);
    check(found.probe.gradient, exact.probe.gradient, found.probe.gradient_time_estimate);
    check(found.history.flux_out, exact.history.flux_out, found.history.flux_out_time_estimate);
  }
}

/// A step changes conductivities by no more than the tolerance of its forecast.
TEST(DischargeRows, HaveEstimatesOfWhatTransportChanged) {
  Scene scene = eroding_scene();
  for (const double tolerance : {1e-2, 1e-3}) {
    const HistoryRow row = seen_at(observed_pond(scene, tolerance), 100.0).history;
    EXPECT_GT(row.flux_out_transport_estimate, 0.0);
    EXPECT_LT(row.flux_out_transport_estimate, tolerance * row.flux_out);
  }
}

TEST(DischargeRows, HaveNothingUnlessAskedFor) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::steady;
  Case<2> c = pond(scene);
  c.document.scene.mesh.error.reset();
  model::ModelRun run(std::move(c));
  EXPECT_EQ(run.state().history.flux_out_high, 0.0);
  EXPECT_FALSE(run.model().flow_state().bounds);
}

}  // namespace discharge_rows_test
}  // namespace suffuse
