/// Operations that the plan skips in time change no bit of the results.

#include <gtest/gtest.h>

#include "physics/numbers.hpp"
#include "solver/double_point_case.hpp"
#include "verification/model_run.hpp"

namespace suffuse {
namespace skip_test {

Scene single_point_scene(FlowScheme scheme) {
  Scene scene = model::paper_scene();
  scene.soils[0].erosion.law = erosion_law("constant");
  scene.soils[0].erosion.rate = 2e-2;
  scene.soils[0].erosion.start = 2.0;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  scene.time.scheme = scheme;
  scene.time.end = 10.0;
  return scene;
}

Case<2> double_point_case(FlowScheme scheme, PressureIntegration integration) {
  Scene scene = model::double_point_scene(0.012, 2e-2);
  scene.time.scheme = scheme;
  scene.time.end = 10.0;
  // There are fewer steps; each does the same.
  if (scheme == FlowScheme::explicit_nodal) scene.time.mass_scaling = 100.0;
  scene.flow.integration = integration;
  LayerSettings layers;
  layers.inflow = layers.outflow = layers.above = layers.below = 1;
  return model::make_double_point_case(model::layered_mesh(4, layers), scene);
}

/// The same plan without skips in time.
Plan without_spans(Plan plan) {
  plan.erosion_span = {};
  plan.fines_from = -infinity;
  return plan;
}

/// All values of history and ledger at each output time, with the number of calls of a pass.
struct Record {
  std::vector<double> values;
  long calls = 0;
};

template <template <int> class Model>
Record record(const Case<2>& c, const Plan& plan, const std::string& pass) {
  Model<2> model(c, plan);
  Record result;
  const double end = c.document.scene.time.end;
  for (double next = 0.5; next <= end; next += 0.5) {
    while (model.time() < next) model.advance(next);
    const HistoryRow history = model.history_row(model.flow_state());
    for (const auto& [name, member, unit] : history_columns)
      result.values.push_back(history.*member);
    const LedgerRow ledger = model.ledger();
    for (const auto& [name, member, unit] : ledger_columns) result.values.push_back(ledger.*member);
    const std::vector<double>& porosity = model.solid().porosity();
    result.values.insert(result.values.end(), porosity.begin(), porosity.end());
  }
  for (const PassTiming& timing : model.passes()) {
    if (timing.name == pass) result.calls = timing.calls;
  }
  return result;
}

/// With and without the plan's spans: the same values, and fewer calls of `pass`.
template <template <int> class Model>
void expect_the_same(const Case<2>& c, const std::string& pass) {
  const Plan plan = make_plan(c, {});
  EXPECT_EQ(plan.erosion_span.start, 2.0);
  EXPECT_NEAR(plan.erosion_span.end, 7.0, 1e-5);
  const Record with = record<Model>(c, plan, pass);
  const Record without = record<Model>(c, without_spans(plan), pass);
  ASSERT_GT(with.values.size(), 20U * 30U);
  EXPECT_EQ(with.values, without.values) << pass;
  EXPECT_LT(with.calls, without.calls) << pass;
  EXPECT_GT(with.calls, 0) << pass;
}

TEST(SkipInTime, SinglePointIsTheSameToTheLastBit) {
  for (const FlowScheme scheme : {FlowScheme::explicit_nodal, FlowScheme::implicit_mixed}) {
    const Case<2> c = model::make_case(model::column_mesh(4, 4), single_point_scene(scheme));
    expect_the_same<SinglePoint>(c, "erosion");
    expect_the_same<SinglePoint>(c, "transport");
  }
}

TEST(SkipInTime, DoublePointIsTheSameToTheLastBit) {
  const std::string pass = "erosion";
  expect_the_same<DoublePoint>(
      double_point_case(FlowScheme::explicit_nodal, PressureIntegration::mixed), pass);
  expect_the_same<DoublePoint>(
      double_point_case(FlowScheme::implicit_mixed, PressureIntegration::mixed), pass);
  expect_the_same<DoublePoint>(
      double_point_case(FlowScheme::explicit_nodal, PressureIntegration::material_point), pass);
}

TEST(SkipInTime, OnlyWhatIsCertain) {
  Scene scene = single_point_scene(FlowScheme::explicit_nodal);
  const auto plan_of = [&](const SolverOptions& options = {}) {
    return make_plan(model::make_case(model::column_mesh(4, 4), scene), options);
  };
  const auto says = [](const Plan& plan, const std::string& sentence) {
    return std::count(plan.sentences.begin(), plan.sentences.end(), sentence) == 1;
  };
  EXPECT_TRUE(says(plan_of(), "skip: erosion before t = 2 s and after t = 7 s, nothing can erode"));
  EXPECT_TRUE(says(plan_of(), "skip: transport before t = 2 s, no grains in the liquid"));
  EXPECT_TRUE(plan_of({.threads = 1, .no_skip = true}).erosion_span.meets(0.0, 1.0));
  EXPECT_TRUE(plan_of({.threads = 1, .no_skip = true}).erosion_span.meets(8.0, 9.0));
  EXPECT_TRUE(1.0 > plan_of({.threads = 1, .no_skip = true}).fines_from);
  EXPECT_FALSE(plan_of().erosion_span.meets(0.0, 2.0));
  EXPECT_TRUE(plan_of().erosion_span.meets(0.0, 2.1));
  EXPECT_FALSE(2.0 > plan_of().fines_from);

  // Grains of the inflow are present from the start.
  scene.boundaries[0].concentration = 0.1;
  EXPECT_TRUE(0.1 > plan_of().fines_from);
  EXPECT_FALSE(plan_of().erosion_span.meets(0.0, 2.0));

  // Elements without liquid keep their fines for later.
  scene.soils[0].erosion.empty_elements = EmptyElements::dry;
  EXPECT_EQ(plan_of().erosion_span.end, infinity);
  // With these laws erosion never ends completely.
  scene.soils[0].erosion.empty_elements = EmptyElements::wet;
  for (const ErosionLaw* law :
       {erosion_law("logarithmic"), erosion_law("first-order"), erosion_law("flux")}) {
    scene.soils[0].erosion.law = law;
    EXPECT_EQ(plan_of().erosion_span.start, 2.0);
    EXPECT_EQ(plan_of().erosion_span.end, infinity);
  }
}

}  // namespace skip_test
}  // namespace suffuse
