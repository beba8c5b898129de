/// Hydraulic gradients, power and total conductivity, compared with their values in flow along a
/// column.

#include "formulation/seepage_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "driver/spent_energy.hpp"
#include "model_run.hpp"

namespace suffuse {
namespace seepage_measures_test {

constexpr double weight = 1000.0 * 9.81;

/// A column of 1 m, the lower half of which may be another soil that does not erode.
Case<2> column(bool layered) {
  Scene scene = model::paper_scene();
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  scene.soils[0].erosion = {erosion_law("constant"), 1e-3, 2.0, false};
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  scene.initial_flow = InitialFlow::steady;
  scene.time.scheme = FlowScheme::implicit_mixed;
  // Compressed water would flow faster towards the outlet.
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.time.end = 60.0;
  Mesh<2> mesh = model::column_mesh(2, 8);
  if (layered) {
    scene.soils.push_back(scene.soils[0]);
    scene.soils[1].region = "lower";
    scene.soils[1].conductivity = 5e-3;
    scene.soils[1].erosion = {};
    mesh.region_names.emplace_back("lower");
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (element_centroid(mesh, e)[1] < 0.5) mesh.element_region[e] = 1;
    }
  }
  return model::make_case(mesh, scene);
}

TEST(SeepageMeasures, GradientIsThatOfTheHead) {
  Case<2> c = column(false);
  c.document.scene.soils[0].erosion = {};
  model::ModelRun run(std::move(c));
  const auto moments = run.run({10.0});
  const VectorField<2> gradient =
      hydraulic_gradient(run.model().grid(), moments.flows[0], run.input().document.scene);
  for (const Vector<2>& i : gradient) {
    EXPECT_NEAR(i[0], 0.0, 1e-10);
    EXPECT_NEAR(i[1], -6000.0 / weight, 1e-10);
  }
}

/// Under gravity the pressure of water at rest drives no flow.
TEST(SeepageMeasures, WaterAtRestHasNoGradient) {
  Case<2> c = column(false);
  c.document.scene.gravity = {0.0, -9.81, 0.0};
  c.document.scene.boundaries = {model::pressure_on("top", 0.0),
                                 model::pressure_on("bottom", weight)};
  c.document.scene.soils[0].erosion = {};
  model::ModelRun run(std::move(c));
  const auto moments = run.run({10.0});
  const VectorField<2> gradient =
      hydraulic_gradient(run.model().grid(), moments.flows[0], run.input().document.scene);
  for (const Vector<2>& i : gradient) EXPECT_LT(i.norm(), 1e-10);
}

/// Along a column: P = rho_w g Q h, and k_eff / k_0 is the discharge over that at the start,
/// because the head is constant.
class AlongAColumn : public ::testing::TestWithParam<bool> {};

TEST_P(AlongAColumn, PowerAndConductivityAreThoseOfTheWhole) {
  model::ModelRun run(column(GetParam()));
  const auto moments = run.run({0.0, 20.0, 60.0});
  const HistoryRow& first = moments.states[0].history;
  EXPECT_NEAR(first.conductivity_ratio, 1.0, 1e-9);
  for (const auto& state : moments.states) {
    const HistoryRow& row = state.history;
    EXPECT_NEAR(row.power, row.flux_out * 6000.0, 1e-7 * row.power);
    // Water that fills the eroded volume makes the fluxes differ by 1e-4.
    EXPECT_NEAR(row.conductivity_ratio, row.flux_out / first.flux_out,
                2e-3 * row.conductivity_ratio);
  }
  EXPECT_GT(moments.states[2].history.conductivity_ratio, GetParam() ? 1.05 : 1.5);
}

INSTANTIATE_TEST_SUITE_P(Columns, AlongAColumn, ::testing::Bool());

/// Soil that fills with water conducts more than it did, but its conductivity is the same.
TEST(SeepageMeasures, SoilThatFillsKeepsItsConductivity) {
  Case<2> c = column(false);
  Scene& scene = c.document.scene;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.boundaries = {model::pressure_on("bottom", 2.0 * weight)};
  scene.water_level = -2.0;
  scene.soils[0].erosion = {};
  scene.soils[0].retention = model::van_genuchten(2.0, 2.0);
  scene.soils[0].conductivity = 1e-4;
  scene.initial_flow = InitialFlow::rest;
  scene.time.end = 200.0;
  model::ModelRun run(std::move(c));
  for (const auto& state : run.run({50.0, 100.0, 200.0}).states) {
    std::cout << "t = " << state.time << " s: " << state.history.conductivity_ratio << "\n";
    EXPECT_NEAR(state.history.conductivity_ratio, 1.0, 0.01);
  }
}

/// Fines in the liquid drive it by their weight, which is no conductivity of the soil.
TEST(SeepageMeasures, WeightOfFinesChangesNoConductivity) {
  Case<2> c = column(false);
  Scene& scene = c.document.scene;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.boundaries = {model::pressure_on("top", 0.5 * weight),
                      model::pressure_on("bottom", 1.2 * weight)};
  scene.boundaries[0].concentration = 0.2;
  scene.soils[0].erosion = {};
  scene.time.end = 2e3;
  model::ModelRun run(std::move(c));
  for (const auto& state : run.run({0.0, 500.0, 2e3}).states) {
    const HistoryRow& row = state.history;
    std::cout << row.conductivity_ratio << ", " << row.fines_weight_share << '\n';
    EXPECT_NEAR(row.conductivity_ratio, 1.0, 1e-3);
    EXPECT_GT(row.power, 0.0);
  }
  EXPECT_GT(run.state().history.fines_weight_share, 0.3);
}

TEST(SeepageMeasures, LossesAreThoseOfTheLedger) {
  model::ModelRun run(column(false));
  run.run({60.0});
  const HistoryRow row = run.state().history;
  const LedgerRow ledger = run.state().ledger;
  EXPECT_EQ(row.eroded, ledger.eroded);
  EXPECT_EQ(row.fines_out, ledger.fines_out);
  EXPECT_GT(row.fines_out, 0.0);
  const double fines = ledger.erodible + ledger.eroded;
  EXPECT_NEAR(row.fines_out_percent, 100.0 * ledger.fines_out / fines, 1e-9);
  EXPECT_NEAR(row.solid_out_percent, 100.0 * ledger.fines_out / (ledger.solid + ledger.eroded),
              1e-9);
}

TEST(SpentEnergy, IsExactForPowerThatIsLinearInTime) {
  SpentEnergy energy;
  HistoryRow row;
  for (const double t : {0.0, 1.0, 4.0}) {
    row.t = t;
    row.power = 3.0 + 2.0 * t;
    EXPECT_NEAR(energy.at(row), 3.0 * t + t * t, 1e-14);
  }
}

}  // namespace seepage_measures_test
}  // namespace suffuse
