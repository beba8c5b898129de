/// Flow that erodes, deposits, reverses and erodes again: conditions that must always hold.

#include <gtest/gtest.h>

#include <cmath>

#include "model_run.hpp"

namespace suffuse {
namespace reversal_test {

constexpr double end_time = 240.0;
constexpr double least_porosity = 0.22;

struct ReversalCase {
  const char* name;
  Formulation formulation;
  FlowScheme scheme;
};

void PrintTo(const ReversalCase& c, std::ostream* stream) {
  *stream << c.name;
}

/// Fast flow downwards erodes fines, slow flow deposits them, fast flow upwards erodes them again.
Scene reversal_scene(Formulation formulation, FlowScheme scheme) {
  Scene scene = model::paper_scene();
  scene.formulation = formulation;
  Soil& soil = scene.soils[0];
  soil.erosion.law = erosion_law("first-order");
  soil.erosion.drive = drive_law("shear-stress");
  soil.erosion.rate = 1e-2;
  soil.erosion.threshold = 0.2;
  soil.erosion.residual.pairs = {{0.0, 0.03}, {0.02, 0.005}};
  soil.erosion.critical_concentration = 0.3;
  soil.deposition.coefficient = 8.0;
  soil.deposition.porosity_min = least_porosity;
  soil.deposition.flux_max = 8e-3;
  soil.conductivity_law = conductivity_law("kozeny-carman");
  soil.conductivity_parameters.size_ratio = 3.0;
  scene.liquid.viscosity_model.law = viscosity_laws()[1];
  const double fast = 6e3;
  const double slow = 1.5e3;
  scene.boundaries = {model::pressure_on("top", fast), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].pressure =
      TimeFunction({{0.0, fast}, {60.0, fast}, {70.0, slow}, {130.0, slow}, {160.0, -fast}});
  scene.boundaries[0].concentration = 0.05;
  scene.boundaries[1].concentration = 0.01;
  scene.time.scheme = scheme;
  scene.time.end = end_time;
  if (scheme == FlowScheme::explicit_nodal) {
    scene.liquid.bulk_modulus = 1e6;
    scene.time.mass_scaling = 100.0;
  }
  scene.output.every = scene.output.snapshot_every = end_time;
  return scene;
}

std::vector<double> moments_of_run() {
  std::vector<double> times;
  for (int k = 1; k <= 48; ++k) times.push_back(end_time * k / 48);
  return times;
}

/// Concentrations at all places of the liquid.
std::vector<double> concentrations(const FinesState<2>& liquid) {
  std::vector<double> result;
  for (std::size_t e = 0; e < liquid.fines_volume.size(); ++e) {
    for (int j = 0; j < 3; ++j) {
      result.push_back(liquid.fines_volume[e][j] / liquid.liquid_volume[e][j]);
    }
  }
  return result;
}
std::vector<double> concentrations(const LiquidPoints<2>& liquid) {
  std::vector<double> result;
  for (int p = 0; p < liquid.size(); ++p) {
    const double fines = liquid.fines_mass[p] / 2700.0;
    result.push_back(fines / (fines + liquid.water_mass[p] / 1000.0));
  }
  return result;
}

template <class Run>
void expect_invariants(Run run) {
  const auto moments = run.run(moments_of_run());
  EXPECT_LE(run.worst_residual(), 1e-12);
  const LedgerRow* before = nullptr;
  const double solid = moments.states.front().ledger.solid + moments.states.front().ledger.eroded -
                       moments.states.front().ledger.deposited;
  for (const auto& state : moments.states) {
    for (const double c : concentrations(state.liquid)) {
      EXPECT_GE(c, -1e-13) << state.time;
      EXPECT_LT(c, 0.62) << state.time;
    }
    for (const double n : state.porosity) {
      EXPECT_GE(n, least_porosity) << state.time;
      EXPECT_LE(n, 0.4 - 0.005 + 1e-12) << state.time;
    }
    const LedgerRow& row = state.ledger;
    EXPECT_NEAR(row.solid - solid, row.deposited - row.eroded, 1e-12 * solid) << state.time;
    if (before != nullptr) {
      // Eroded mass is counted as the sum of deposits and loss of the solid, up to round-off.
      EXPECT_GE(row.eroded, before->eroded - 1e-14 * solid) << state.time;
      EXPECT_GE(row.deposited, before->deposited - 1e-14 * solid) << state.time;
    }
    before = &state.ledger;
  }
  // The flow really reversed: fines left, were caught, and left again.
  const auto at = [&](double time) {
    return moments.states[std::lround(48.0 * time / end_time) - 1].ledger;
  };
  const double some = 1e-3 * solid;
  EXPECT_GT(at(60.0).eroded, some);
  EXPECT_GT(at(130.0).deposited - at(70.0).deposited, 10.0 * some / 100.0);
  EXPECT_GT(at(240.0).eroded - at(160.0).eroded, some);
}

class Reversal : public ::testing::TestWithParam<ReversalCase> {};

TEST_P(Reversal, KeepsWhatMustHold) {
  const ReversalCase& c = GetParam();
  const Scene scene = reversal_scene(c.formulation, c.scheme);
  if (c.formulation == Formulation::single_point) {
    expect_invariants(model::ModelRun(model::make_case(model::column_mesh(3, 8, 0.4), scene)));
  } else {
    expect_invariants(
        model::DoublePointRun(model::make_double_point_case(model::column_mesh(3, 8, 0.4), scene)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Modes, Reversal,
    ::testing::Values(ReversalCase{"single_point_implicit", Formulation::single_point,
                                   FlowScheme::implicit_mixed},
                      ReversalCase{"single_point_explicit", Formulation::single_point,
                                   FlowScheme::explicit_nodal},
                      ReversalCase{"double_point_implicit", Formulation::double_point,
                                   FlowScheme::implicit_mixed}),
    [](const auto& param_info) { return param_info.param.name; });

template <class Run>
Snapshot last_snapshot(Run run) {
  run.run({10.0, 25.0});
  return run.model().snapshot(run.model().flow_state());
}

void expect_same_bits(const Snapshot& one, const Snapshot& two) {
  for (const auto& [a, b] :
       {std::pair{&one.cell, &two.cell}, std::pair{&one.node, &two.node},
        std::pair{&one.solid, &two.solid}, std::pair{&one.element_vertex, &two.element_vertex}}) {
    ASSERT_EQ(a->size(), b->size());
    for (std::size_t k = 0; k < a->size(); ++k) EXPECT_EQ((*a)[k].values, (*b)[k].values);
  }
}

/// There are more elements (single-point) and points than the loops need to be parallel.
TEST(Reversal, OneAndTwoThreadsGiveTheSameBits) {
  const auto single = [](int threads) {
    Scene scene = reversal_scene(Formulation::single_point, FlowScheme::implicit_mixed);
    scene.time.step = 5.0;
    scene.boundaries[0].pressure = TimeFunction({{0.0, 6e3}, {8.0, 6e3}, {10.0, 1.5e3}});
    return last_snapshot(
        model::ModelRun(model::make_case(model::column_mesh(46, 46), scene), {.threads = threads}));
  };
  expect_same_bits(single(1), single(2));
  const auto twofold = [](int threads) {
    Scene scene = reversal_scene(Formulation::double_point, FlowScheme::implicit_mixed);
    scene.points.liquid_per_element = 3;
    scene.time.step = 5.0;
    scene.boundaries[0].pressure = TimeFunction({{0.0, 6e3}, {8.0, 6e3}, {10.0, 1.5e3}});
    return last_snapshot(model::DoublePointRun(
        model::make_double_point_case(model::column_mesh(24, 32), scene), {.threads = threads}));
  };
  expect_same_bits(twofold(1), twofold(2));
}

}  // namespace reversal_test
}  // namespace suffuse
