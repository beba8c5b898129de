/// States that must not move, and runs that must stay bounded.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "free_mesh.hpp"
#include "model_run.hpp"
#include "scheme_case.hpp"

namespace suffuse {
namespace equilibrium_test {

const auto schemes =
    ::testing::Values(model::explicit_scheme, model::implicit_scheme, model::implicit_one_second);

std::string name_of(const ::testing::TestParamInfo<model::SchemeCase>& info) {
  return info.param.name;
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double v : values) result = std::max(result, std::abs(v));
  return result;
}

double largest_speed(const VectorField<2>& velocity) {
  double result = 0.0;
  for (const Vector<2>& v : velocity) result = std::max(result, v.norm());
  return result;
}

class SealedBox : public ::testing::TestWithParam<model::SchemeCase> {};
INSTANTIATE_TEST_SUITE_P(Schemes, SealedBox, schemes, name_of);

TEST_P(SealedBox, ErosionSourcesNoPressureAndLosesNoMass) {
  for (const ErosionLaw* law : {erosion_law("constant"), erosion_law("logarithmic")}) {
    Scene scene = model::paper_scene();
    scene.soils[0].erosion = {law, law == erosion_law("constant") ? 5e-3 : 1e-2, 2.0, false};
    scene.time.end = 30.0;
    GetParam().apply(scene);
    model::ModelRun run(
        model::make_case(model::column_mesh(6, 6, 1.0, 1.0, model::jittered(0.04, 7)), scene));
    const auto moments = run.run({1.0, 5.0, 10.0, 22.0, 30.0});
    for (std::size_t k = 0; k < moments.flows.size(); ++k) {
      EXPECT_LE(largest(moments.flows[k].pressure), 1e-8 * scene.liquid.bulk_modulus);
      const LedgerRow row = moments.states[k].ledger;
      EXPECT_EQ(row.water_in + row.water_out + row.fines_in + row.fines_out, 0.0);
      EXPECT_NEAR(row.fines, row.eroded, 1e-12 * row.solid);
    }
    EXPECT_LE(run.worst_residual(), 1e-12);
    // All eroded fines are still in the box.
    EXPECT_GT(moments.states.back().ledger.fines, 100.0);
  }
}

/// The unit square in Gmsh's unstructured mesh; its upper half is another region.
Mesh<2> two_soils_free_mesh(double size) {
  Mesh<2> mesh = model::free_mesh(size);
  mesh.region_names = {"specimen", "loose"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 0.5 ? 1 : 0;
  }
  return mesh;
}

class HydrostaticRest : public ::testing::TestWithParam<model::SchemeCase> {};
INSTANTIATE_TEST_SUITE_P(Schemes, HydrostaticRest, schemes, name_of);

TEST_P(HydrostaticRest, StaysAtRestOnAnUnstructuredMeshWithTwoPorosities) {
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, -9.81, 0.0};
  Soil loose = scene.soils[0];
  loose.region = "loose";
  loose.porosity = 0.38;
  loose.conductivity = 0.1;
  scene.soils.push_back(loose);
  scene.boundaries = {model::pressure_on("top", 0.0)};
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = 1.0;
  GetParam().apply(scene);
  model::ModelRun run(model::make_case(two_soils_free_mesh(0.12), scene));
  const Mesh<2>& mesh = run.input().mesh;
  const FlowState<2> begin = run.model().flow_state();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double depth = 1.0 - element_centroid(mesh, e)[1];
    EXPECT_NEAR(begin.pressure[e], 9810.0 * depth, 1e-6) << "the steady state is hydrostatic";
  }
  EXPECT_LE(largest_speed(begin.velocity), 1e-10);
  const auto moments = run.run({0.25, 0.5, 1.0});
  for (const auto& flow : moments.flows) EXPECT_LE(largest_speed(flow.velocity), 1e-10);
  std::cout << "largest speed after " << run.steps()
            << " steps: " << largest_speed(moments.flows.back().velocity) << " m/s\n";
}

TEST(EquationOfState, PressureIsThatOfTheMasses) {
  // From rest, with waves and erosion, the pressure that the flow integrates and that of the masses
  // could diverge.
  Scene scene = model::paper_scene();
  scene.soils[0].erosion = {erosion_law("logarithmic"), 1e-2, 0.0, false};
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  scene.time.mass_scaling = 1e4;
  scene.time.end = 30.0;
  model::ModelRun run(model::make_case(model::column_mesh(4, 4), scene));
  run.run({30.0});
  const FinesState<2>& liquid = run.model().liquid();
  const std::vector<double> pressure = run.model().flow_state().pressure;
  for (std::size_t e = 0; e < pressure.size(); ++e) {
    const double water =
        element_sum<2>(liquid.liquid_volume[e]) - element_sum<2>(liquid.fines_volume[e]);
    const double expected =
        scene.liquid.bulk_modulus * std::log(run.model().water_mass()[e] / (1000.0 * water));
    EXPECT_NEAR(pressure[e], expected, 1e-6);
  }
}

class SteadyFlow : public ::testing::TestWithParam<model::SchemeCase> {};
INSTANTIATE_TEST_SUITE_P(Schemes, SteadyFlow, schemes, name_of);

TEST_P(SteadyFlow, StaysSteady) {
  Scene scene = model::paper_scene();
  scene.boundaries = {model::flux_on("top", 0.012), model::pressure_on("bottom", 0.0)};
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = 1.0;
  GetParam().apply(scene);
  model::ModelRun run(model::make_case(model::column_mesh(4, 8), scene));
  const auto moments = run.run({0.1, 1.0});
  for (std::size_t k = 0; k < 2; ++k) {
    const HistoryRow row = moments.states[k].history;
    // p/K is 3e-4 here: the water expands by that share on its way.
    EXPECT_NEAR(row.flux_out, 0.012, 0.012 * 4e-4);
  }
}

}  // namespace equilibrium_test
}  // namespace suffuse
