/// Scenes without a smooth solution for the implicit flow: coefficients that transport changes
/// between steps, sudden resistance of soil, jumps of pressure. They must neither stop a run nor
/// need an unlimited number of steps.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>

#include "model_run.hpp"
#include "scheme_case.hpp"

namespace suffuse {
namespace implicit_robustness_test {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The paper's column half a metre wide, a pressure on top of it, eroding within 20 s.
Scene column(Formulation formulation) {
  Scene scene = model::paper_scene();
  scene.formulation = formulation;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  scene.soils.front().erosion = {erosion_law("constant"), 5e-3, 2.0, false};
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.inertia = false;
  scene.time.end = 40.0;
  scene.points.liquid_per_element = 6;
  return scene;
}

Case<2> case_of(const Scene& scene) {
  Mesh<2> mesh = model::column_mesh(2, 4, 0.5, 1.0);
  return scene.formulation == Formulation::single_point
             ? model::make_case(std::move(mesh), scene)
             : model::make_double_point_case(std::move(mesh), scene);
}

struct HardScene {
  const char* name;
  std::function<void(Scene&)> change;
  long max_steps;
};

std::ostream& operator<<(std::ostream& out, const HardScene& scene) {
  return out << scene.name;
}

void jump(Scene& scene, double within) {
  scene.boundaries[0].pressure = TimeFunction(
      {{0.0, 0.0}, {10.0, 0.0}, {10.0 + within, 6000.0}, {20.0, 6000.0}, {20.0 + within, 1000.0}});
}

class HardScenes : public ::testing::TestWithParam<HardScene> {};
INSTANTIATE_TEST_SUITE_P(
    All, HardScenes,
    ::testing::Values(
        HardScene{"JumpOfPressure", [](Scene& s) { jump(s, 1e-7); }, 400},
        HardScene{"JumpShorterThanTimeHasDigitsFor", [](Scene& s) { jump(s, 1e-10); }, 400},
        HardScene{"JumpInSoftWater",
                  [](Scene& s) {
                    s.liquid.bulk_modulus = 2e5;
                    jump(s, 1e-7);
                  },
                  400},
        HardScene{"JumpInTightSoil",
                  [](Scene& s) {
                    s.soils[0].conductivity = 1e-6;
                    jump(s, 1e-7);
                  },
                  400},
        HardScene{"FluxLawWithFeedback",
                  [](Scene& s) {
                    s.soils[0].erosion = {erosion_law("flux"), 5.0, 2.0, false};
                    s.soils[0].conductivity_law = conductivity_law("kozeny-carman");
                  },
                  300},
        HardScene{"MomentumOfAllFinesAtOnce",
                  [](Scene& s) {
                    s.soils[0].erosion = {erosion_law("constant"), 1e3, 2.0, true};
                  },
                  300},
        HardScene{"MomentumAndSmallTolerance",
                  [](Scene& s) {
                    s.soils[0].erosion = {erosion_law("logarithmic"), 1e-2, 2.0, true};
                    s.time.tolerance = 1e-6;
                  },
                  6000},
        HardScene{"HeavyLiquid",
                  [](Scene& s) {
                    s.gravity = {0.0, -9.81};
                  },
                  2000},
        HardScene{"HeavyLiquidAndFeedback",
                  [](Scene& s) {
                    s.gravity = {0.0, -9.81};
                    s.soils[0].conductivity_law = conductivity_law("kozeny-carman");
                  },
                  2000},
        HardScene{"HeavyLiquidAtRest",
                  [](Scene& s) {
                    s.gravity = {0.0, -9.81};
                    s.boundaries[0].pressure = 0.0;
                    s.boundaries[1].pressure = 9810.0;
                  },
                  2000},
        HardScene{"HeavyStiffLiquid",
                  [](Scene& s) {
                    s.gravity = {0.0, -9.81};
                    s.liquid.bulk_modulus = infinite;
                  },
                  2000}),
    [](const auto& param_info) { return param_info.param.name; });

template <class Run>
void runs_to_its_end(Formulation formulation) {
  const HardScene& hard = HardScenes::GetParam();
  Scene scene = column(formulation);
  hard.change(scene);
  Run run(case_of(scene));
  const auto moments = run.run({1.0, 5.0, 12.0, 21.0, scene.time.end});
  for (const FlowState<2>& flow : moments.flows) {
    for (const double q : flow.face_flux) ASSERT_TRUE(std::isfinite(q));
  }
  for (const double n : moments.states.back().porosity) EXPECT_LE(n, 0.4 + 1e-12);
  std::cout << run.steps() << " steps\n";
  EXPECT_LE(run.steps(), hard.max_steps);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

TEST_P(HardScenes, SinglePointRuns) {
  runs_to_its_end<model::ModelRun>(Formulation::single_point);
}

TEST_P(HardScenes, DoublePointRuns) {
  runs_to_its_end<model::DoublePointRun>(Formulation::double_point);
}

/// Free water over and under soil is as heavy as the fines in it make it, and almost without
/// resistance: a point that crosses a face must not make its weight jump.
TEST(HeavyLiquid, FlowsThroughFreeWaterInDoublePoint) {
  LayerSettings layers;
  layers.inflow = layers.above = layers.below = layers.outflow = 2;
  Scene scene = model::double_point_scene(0.012, 5e-3);
  scene.gravity = {0.0, -9.81};
  model::implicit_scheme.apply(scene);
  scene.time.end = 30.0;
  model::DoublePointRun run(model::make_double_point_case(model::layered_mesh(4, layers), scene));
  const auto moments = run.run({10.0, 20.0, 30.0});
  std::cout << run.steps() << " steps\n";
  EXPECT_LE(run.steps(), 3000);
  EXPECT_LE(run.worst_residual(), 1e-12);
  for (std::size_t k = 0; k < 3; ++k) {
    const HistoryRow row = moments.states[k].history;
    EXPECT_NEAR(row.flux_in, 0.012, 1e-12);
    EXPECT_GE(row.concentration_min, 0.0);
    EXPECT_LT(row.concentration_max, 1.0);
  }
}

/// Feedback begins after the start-up, whose first fluxes are many times the later ones, has
/// settled and steps have grown long.
TEST(FeedbackAfterAStart, KeepsTheToleranceAndDoesNotSeeSkips) {
  const std::vector<double> times{3.0, 6.0, 9.0, 12.0, 15.0};
  const auto flows = [&](double tolerance, bool no_skip) {
    Scene scene = column(Formulation::single_point);
    scene.soils[0].erosion = {erosion_law("flux"), 5.0, 2.0, false};
    scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
    scene.time.tolerance = tolerance;
    SolverOptions options;
    options.no_skip = no_skip;
    model::ModelRun run(case_of(scene), options);
    return run.run(times).flows;
  };
  const auto difference = [&](const auto& a, const auto& b) {
    double worst = 0.0;
    double largest = 0.0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      for (std::size_t f = 0; f < a[k].face_flux.size(); ++f) {
        worst = std::max(worst, std::abs(a[k].face_flux[f] - b[k].face_flux[f]));
        largest = std::max(largest, std::abs(b[k].face_flux[f]));
      }
    }
    return worst / largest;
  };
  const auto usual = flows(1e-3, false);
  const double error = difference(usual, flows(1e-5, false));
  const double skipped = difference(usual, flows(1e-3, true));
  std::cout << "flux off by " << error << " (tolerance), " << skipped << " (skips)\n";
  EXPECT_LE(error, 1e-3);
  EXPECT_LE(skipped, 1e-4);
}

/// Stiff water in a column: the flux follows from the head and the weight of the liquid.
TEST(HeavyLiquid, FlowsAsItsWeightTellsIt) {
  for (const double tolerance : {1e-3, 1e-4}) {
    Scene scene = column(Formulation::single_point);
    scene.gravity = {0.0, -9.81};
    scene.liquid.bulk_modulus = infinite;
    scene.time.tolerance = tolerance;
    model::ModelRun run(case_of(scene));
    const Grid<2> grid(run.input().mesh);
    const auto moments = run.run({3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 21.0, 25.0, 35.0});
    double worst = 0.0;
    for (std::size_t k = 0; k < moments.flows.size(); ++k) {
      const FinesState<2>& liquid = moments.states[k].liquid;
      double weight = 0.0;  // per area
      for (int e = 0; e < grid.mesh.element_count(); ++e) {
        const double c =
            element_sum<2>(liquid.fines_volume[e]) / element_sum<2>(liquid.liquid_volume[e]);
        weight += grid.volume[e] / 0.5 * (1000.0 + c * 1700.0) * 9.81;
      }
      const double flux = 2e-2 / 9810.0 * (6000.0 + weight);
      double through = 0.0;
      for (int f = 0; f < grid.face_count(); ++f) {
        if (grid.is_outer(f)) through += 0.5 * std::abs(moments.flows[k].face_flux[f]) / 0.5;
      }
      worst = std::max(worst, std::abs(through / flux - 1.0));
    }
    std::cout << "tolerance " << tolerance << ": flux off by " << worst << " in " << run.steps()
              << " steps\n";
    EXPECT_LE(worst, 3.0 * tolerance);
  }
}

/// Outputs end steps: a run with many outputs has other steps, with equal results within the
/// tolerance.
template <class Run>
void outputs_change_little(Formulation formulation) {
  Scene scene = column(formulation);
  scene.liquid.bulk_modulus = infinite;  // few steps except for the outputs
  std::vector<double> often;
  for (int k = 1; k <= 400; ++k) often.push_back(0.1 * k);
  Run few_outputs(case_of(scene));
  Run many_outputs(case_of(scene));
  const LedgerRow few = few_outputs.run({40.0}).states.back().ledger;
  const auto states = many_outputs.run(often).states;
  const LedgerRow many = states.back().ledger;
  EXPECT_GE(many_outputs.steps(), 400);
  EXPECT_LT(few_outputs.steps(), 400);
  EXPECT_NEAR(few.eroded, many.eroded, 1e-12 * many.eroded);
  EXPECT_NEAR(few.fines, many.fines, 1e-2 * many.fines);
  EXPECT_NEAR(few.fines_out, many.fines_out, 1e-2 * many.fines_out);
  EXPECT_NEAR(few.water_out, many.water_out, scene.time.tolerance * many.water_out);
  double worst = 0.0;
  for (const auto& state : states) {
    const LedgerRow row = state.ledger;
    worst = std::max({worst, std::abs(row.residual_water), std::abs(row.residual_grains)});
  }
  EXPECT_LE(worst, 1e-12);
}

TEST(Outputs, ChangeLittleInSinglePoint) {
  outputs_change_little<model::ModelRun>(Formulation::single_point);
}

TEST(Outputs, ChangeLittleInDoublePoint) {
  outputs_change_little<model::DoublePointRun>(Formulation::double_point);
}

TEST(Outputs, EndSteps) {
  Scene scene = column(Formulation::single_point);
  scene.time.step = 0.0851;
  model::ModelRun run(case_of(scene));
  // The given step is the longest one: 12 of 0.0833 s up to each second.
  for (const double time : {1.0, 2.0, 3.0}) {
    run.run({time});
    EXPECT_EQ(run.model().time(), time);
    EXPECT_EQ(run.steps(), std::lround(12.0 * time));
    EXPECT_NEAR(run.model().last_step(), 1.0 / 12.0, 1e-12);
  }
}

}  // namespace implicit_robustness_test
}  // namespace suffuse
