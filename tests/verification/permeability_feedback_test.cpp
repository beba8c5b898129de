/// Kozeny-Carman's conductivity under a constant head: erosion opens the pores, and the flux
/// follows.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "model_run.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace permeability_feedback_test {

constexpr double height = 1.0;

Scene feedback_scene(double rate, double flux, double end) {
  Scene scene = model::paper_scene();
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  scene.soils[0].erosion = {erosion_law("constant"), rate, 2.0, false};
  const double gradient = 1000.0 * 9.81 * flux / scene.soils[0].conductivity;
  scene.boundaries = {model::pressure_on("top", gradient * height),
                      model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = end;
  return scene;
}

struct Table {
  std::vector<double> times;
  std::vector<double> fluxes;
  double initial = unset;
};

Table table_of(double rate) {
  Table table;
  for (const auto& row : read_reference("permeability-feedback.csv")) {
    if (row.number("alpha") != rate || row.number("t") > 32.0) continue;
    table.times.push_back(row.number("t"));
    table.fluxes.push_back(row.number("q"));
    table.initial = row.number("q0");
  }
  return table;
}

/// Largest relative error of the flux in and out.
double largest_error(const Scene& scene, const Table& table) {
  model::ModelRun run(model::make_case(model::column_mesh(2, 8), scene));
  const auto moments = run.run(table.times);
  double worst = 0.0;
  for (std::size_t k = 0; k < table.times.size(); ++k) {
    const HistoryRow row = moments.states[k].history;
    for (const double flux : {row.flux_in, row.flux_out}) {
      worst = std::max(worst, std::abs(flux - table.fluxes[k]) / table.fluxes[k]);
    }
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  return worst;
}

class PermeabilityFeedback : public ::testing::TestWithParam<double> {};

/// The flow uses the porosity of its last update, which is at most 0.2 % lower: with d ln KC / d ln
/// n = (3 - n) / (1 - n) < 4.4 the flux is at most 0.9 % lower.
TEST_P(PermeabilityFeedback, FollowsTheReferenceTable) {
  const Table table = table_of(GetParam());
  ASSERT_GE(table.times.size(), 6U);
  const double worst =
      largest_error(feedback_scene(GetParam(), table.initial, table.times.back()), table);
  const double growth = table.fluxes.back() / table.initial;
  std::cout << "alpha = " << GetParam() << ": largest error of the flux " << 100.0 * worst
            << " %, which grew to " << growth << " times\n";
  EXPECT_LT(worst, 0.009);
  EXPECT_GT(growth, 1.4);
}

/// The step is chosen for the later drag, not for that at the start: drag falls by two thirds,
/// which helps if it is stepped explicitly and harms if implicitly.
TEST(PermeabilityFeedback, StepIsSafeToTheEnd) {
  for (const auto drag : {DragIntegration::explicit_drag, DragIntegration::implicit_drag}) {
    Scene scene = feedback_scene(5e-3, 0.012, 30.0);
    scene.soils[0].conductivity = 2e-4;
    scene.time.drag = drag;
    model::ModelRun run(model::make_case(model::column_mesh(2, 8), scene));
    const auto moments = run.run({30.0});
    for (const std::string& warning : run.model().take_warnings()) ADD_FAILURE() << warning;
    const HistoryRow row = moments.states[0].history;
    // Water that enters under 5886 Pa expands by p / K on its way.
    const double expected = 1.2e-4 * 3.2263374;
    EXPECT_NEAR(row.flux_in, expected, 5886.0 / 2e7 * expected);
  }
}

/// Steps are short enough that changes of porosity within them stay below the tolerance.
TEST_P(PermeabilityFeedback, FollowsTheReferenceTableImplicitly) {
  const Table table = table_of(GetParam());
  Scene scene = feedback_scene(GetParam(), table.initial, table.times.back());
  scene.time.scheme = FlowScheme::implicit_mixed;
  const double worst = largest_error(scene, table);
  std::cout << "implicit, alpha = " << GetParam() << ": largest error of the flux " << 100.0 * worst
            << " %\n";
  EXPECT_LT(worst, scene.time.tolerance);
}

INSTANTIATE_TEST_SUITE_P(Rates, PermeabilityFeedback, ::testing::Values(1e-3, 5e-3));

}  // namespace permeability_feedback_test
}  // namespace suffuse
