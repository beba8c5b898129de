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
  const HistoryRow row = run.run({1.0}).states[0].history;
  EXPECT_EQ(row.flux_out_high, 0.0);
  EXPECT_GT(row.flux_out_estimate, 0.0);
}

/// Fluxes are those of the middle of a step, conductivities those of its end.
TEST(DischargeRows, HaveAnEstimateOnceErosionChangesTheConductivity) {
  Scene scene = model::paper_scene();
  scene.initial_flow = InitialFlow::steady;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils[0].erosion.law = erosion_law("first-order");
  scene.soils[0].erosion.rate = 1e-3;
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  Case<2> c = pond(scene);
  model::ModelRun run(std::move(c));
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
