/// Results do not depend on the numbers of elements and nodes, but for round-off.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "free_mesh.hpp"
#include "mesher/shuffled_mesh.hpp"
#include "model_run.hpp"

namespace suffuse {
namespace {

/// Soil of two porosities that erodes by the flux and feels it.
Scene eroding_scene(FlowScheme scheme) {
  Scene scene = model::paper_scene();
  scene.soils[0].porosity_gradient = {0.1, 0.05};
  scene.soils[0].erosion = {ErosionLaw::flux, 2.0, 0.0, false};
  scene.soils[0].conductivity_law = ConductivityLaw::kozeny_carman;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  scene.initial_flow = InitialFlow::steady;
  scene.time.scheme = scheme;
  if (scheme == FlowScheme::explicit_nodal) {
    scene.time.mass_scaling = 1e4;
  } else {
    scene.time.step = 0.25;
  }
  scene.time.end = 2.0;
  return scene;
}

struct Outcome {
  HistoryRow history;
  LedgerRow ledger;
};

Outcome outcome_of(const Mesh<2>& mesh, const Scene& scene) {
  model::ModelRun run(model::make_case(mesh, scene));
  const auto moments = run.run({scene.time.end});
  return {run.model().history_row(moments.states.back(), moments.flows.back()),
          run.model().ledger(moments.states.back())};
}

class Numbering : public testing::TestWithParam<FlowScheme> {};

TEST_P(Numbering, ChangesResultsByRoundOffAlone) {
  const Scene scene = eroding_scene(GetParam());
  const Mesh<2> mesh = model::free_mesh(0.08);
  const Outcome along_curve = outcome_of(mesh, scene);
  const Outcome at_random = outcome_of(test::shuffled(mesh), scene);
  const auto expect_near = [](std::string_view column, double a, double b) {
    EXPECT_NEAR(a, b, 1e-10 * std::max(1.0, std::abs(a))) << column;
  };
  for (const auto& [column, value] : history_columns) {
    expect_near(column, along_curve.history.*value, at_random.history.*value);
  }
  for (const auto& [column, value] : ledger_columns) {
    expect_near(column, along_curve.ledger.*value, at_random.ledger.*value);
  }
  EXPECT_GT(along_curve.ledger.fines_out, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Schemes, Numbering,
                         testing::Values(FlowScheme::explicit_nodal, FlowScheme::implicit_mixed));

}  // namespace
}  // namespace suffuse
