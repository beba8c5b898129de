/// The paper's double-point column: solid mass against the erosion laws, and balances of points and
/// masses.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "double_point_modes.hpp"
#include "reference_table.hpp"
#include "scheme_case.hpp"

namespace suffuse {
namespace double_point_column_test {

constexpr double erodible_mass = 2700.0 * 0.1;  ///< of one square metre of specimen, kg

/// Free water and buffers around the specimen, water entering at 0.12 m/s, from rest.
Scene column_scene(const ErosionLaw* law, double rate, int points, double end,
                   const model::SchemeCase& scheme = model::explicit_scheme) {
  Scene scene = model::double_point_scene(0.0, rate);
  scene.soils.front().erosion.law = law;
  BoundaryCondition inflow;
  inflow.on = "inflow";
  inflow.velocity = 0.12;
  inflow.concentration = 0.0;
  scene.boundaries = {inflow, model::pressure_on("outflow", 0.0)};
  scene.initial_flow = InitialFlow::rest;
  if (scheme.scheme == FlowScheme::explicit_nodal) scene.time.mass_scaling = 1e4;
  scheme.apply(scene);
  scene.time.end = end;
  scene.points.liquid_per_element = points;
  return scene;
}

/// The column in elements of h = 0.25 m.
Case<2> column_case(Scene scene) {
  LayerSettings layers;
  layers.inflow = layers.above = layers.below = layers.outflow = 2;
  return model::make_double_point_case(model::layered_mesh(4, layers), std::move(scene));
}

struct Seen {
  double worst_porosity = 0.0;  ///< largest error, relative to the erodible 0.1
  double worst_solid = 0.0;     ///< of the specimen's solid mass, relative to the erodible mass
  double worst_eroded = 0.0;    ///< likewise
  double worst_residual = 0.0;
  double worst_pending = 0.0;
  double worst_defect = 0.0;
  double points_lost = 0.0;
  double concentration_min = 0.0;
  double concentration_max = 0.0;
  double empty_share = 0.0;  ///< mean share of the elements of soil that are empty
};

/// Runs to the last time of the table and compares all its rows.
Seen compare(const Scene& scene, const std::string& column) {
  std::vector<double> times;
  std::vector<double> porosity;
  for (const auto& row : read_reference("porosity.csv")) {
    if (row.number("t") == 0.0 || row.number("t") > scene.time.end) continue;
    times.push_back(row.number("t"));
    porosity.push_back(row.number(column));
  }
  EXPECT_EQ(times.back(), scene.time.end);
  model::DoublePointRun run(column_case(scene));
  const double initial = run.model().ledger().points;
  const auto moments = run.run(times);
  const int specimen = model::region_index(run.input().mesh, "specimen");
  Seen seen;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const model::ModelState<DoublePoint>& state = moments.states[k];
    const HistoryRow row = state.history;
    const LedgerRow ledger = state.ledger;
    const double solid = state.regions[specimen].ledger.solid;
    const auto note = [](double& worst, double value) { worst = std::max(worst, std::abs(value)); };
    note(seen.worst_porosity, (row.porosity_mean - porosity[k]) / 0.1);
    note(seen.worst_solid, (solid - 2700.0 * (1.0 - porosity[k])) / erodible_mass);
    note(seen.worst_eroded, (ledger.eroded - 2700.0 * (porosity[k] - 0.3)) / erodible_mass);
    note(seen.worst_residual, ledger.residual_water);
    note(seen.worst_residual, ledger.residual_grains);
    note(seen.worst_pending, ledger.pending);
    note(seen.worst_defect, row.volume_defect);
    EXPECT_EQ(row.volume_defect_at.starts_with("element "), row.volume_defect > 0.0);
    note(seen.points_lost, initial + ledger.points_in - ledger.points_out - ledger.points);
    EXPECT_EQ(ledger.points, row.liquid_points);
    seen.concentration_min = std::min(seen.concentration_min, row.concentration_min);
    seen.concentration_max = std::max(seen.concentration_max, row.concentration_max);
    // There are 64 elements of soil: specimen and buffers.
    seen.empty_share += row.empty_elements / 64.0 / static_cast<double>(times.size());
  }
  EXPECT_GT(moments.states.back().ledger.points_out, initial) << "water was to flow";
  return seen;
}

void print(const std::string& name, const Seen& seen) {
  std::cout << name << ": largest error / erodible of porosity " << seen.worst_porosity
            << ", solid " << seen.worst_solid << ", eroded " << seen.worst_eroded << "; residual "
            << seen.worst_residual << ", pending " << seen.worst_pending << ", points lost "
            << seen.points_lost << ", largest c " << seen.concentration_max << ", volume defect "
            << seen.worst_defect << ", empty " << 100.0 * seen.empty_share << " %\n";
}

void expect_balanced(const Seen& seen) {
  EXPECT_EQ(seen.points_lost, 0.0);
  EXPECT_LE(seen.worst_residual, 1e-12);
  EXPECT_EQ(seen.worst_pending, 0.0);
  EXPECT_GE(seen.concentration_min, 0.0);
  EXPECT_LT(seen.concentration_max, 1.0);
}

struct LawCase {
  const char* name;
  const ErosionLaw* law;
  double rate;
  const char* column;  ///< of porosity.csv
  double end;
  double exact;  ///< accuracy to which the solver integrates this law
};

class DoublePointColumn : public ::testing::TestWithParam<std::tuple<LawCase, model::SchemeCase>> {
};

TEST_P(DoublePointColumn, ErodesAsTheLawSays) {
  const auto& [law, scheme] = GetParam();
  const Seen seen = compare(column_scene(law.law, law.rate, 12, law.end, scheme), law.column);
  print(std::string(law.name) + ", " + scheme.name, seen);
  expect_balanced(seen);
  EXPECT_LE(seen.worst_porosity, law.exact);
  EXPECT_LE(seen.worst_solid, law.exact);
  EXPECT_LE(seen.worst_eroded, law.exact);
}

INSTANTIATE_TEST_SUITE_P(
    Laws, DoublePointColumn,
    ::testing::Combine(::testing::Values(LawCase{"constant_1e3", erosion_law("constant"), 1e-3,
                                                 "n_const_alpha1e-3", 120.0, 1e-12},
                                         LawCase{"constant_5e3", erosion_law("constant"), 5e-3,
                                                 "n_const_alpha5e-3", 120.0, 1e-12},
                                         // The table has 14 digits.
                                         LawCase{"logarithmic", erosion_law("logarithmic"), 1e-2,
                                                 "n_log_beta1e-2", 40.0, 1e-12}),
                       ::testing::Values(model::explicit_scheme, model::implicit_scheme,
                                         model::implicit_one_second)),
    [](const auto& param_info) {
      return std::string(std::get<0>(param_info.param).name) + "_" +
             std::get<1>(param_info.param).name;
    });

TEST(DoublePointColumnPoints, FewPointsErodeAsWellWhenEmptyElementsCountAsWet) {
  for (const model::SchemeCase& scheme : {model::explicit_scheme, model::implicit_scheme}) {
    for (const int points : {1, 3}) {
      const Seen seen = compare(column_scene(erosion_law("constant"), 1e-3, points, 60.0, scheme),
                                "n_const_alpha1e-3");
      print(std::to_string(points) + " points, " + scheme.name, seen);
      expect_balanced(seen);
      EXPECT_LE(seen.worst_solid, 1e-12) << points;
      EXPECT_LE(seen.worst_eroded, 1e-12) << points;
    }
  }
}

TEST(DoublePointColumnPoints, InThePapersModeTooFewPointsErodeTooLittle) {
  std::vector<Seen> seen;
  for (const int points : {1, 3, 12}) {
    Scene scene = column_scene(erosion_law("constant"), 1e-3, points, 60.0);
    model::use_paper_mode(scene);
    seen.push_back(compare(scene, "n_const_alpha1e-3"));
    print("paper's mode, " + std::to_string(points) + " points", seen.back());
    expect_balanced(seen.back());
  }
  // Dry elements of the specimen keep their grains.
  EXPECT_GT(seen[0].worst_solid, 1.5 * seen[1].worst_solid);
  EXPECT_GT(seen[1].worst_solid, 1.5 * seen[2].worst_solid);
  EXPECT_LE(seen[2].worst_solid, 0.03);
  // Points come from free water, where each represents 1/N of the liquid of an element, so an
  // element of soil contains 0.3 N points on average, at random. N = 12 leaves exp(-3.6) = 2.7 % of
  // the elements empty.
  const std::vector<double> number{1.0, 3.0, 12.0};
  for (std::size_t k = 0; k < number.size(); ++k) {
    const double expected = std::exp(-0.3 * number[k]);
    EXPECT_LE(seen[k].empty_share, 1.1 * expected) << number[k];
    EXPECT_GE(seen[k].empty_share, 0.6 * expected) << number[k];
  }
}

}  // namespace double_point_column_test
}  // namespace suffuse
