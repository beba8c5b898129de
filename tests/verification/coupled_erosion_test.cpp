/// Erosion that depends on the flow, and flow that depends on erosion, in both formulations and
/// with both schemes.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "model_run.hpp"
#include "reference_table.hpp"
#include "scheme_case.hpp"

namespace suffuse {
namespace coupled_erosion_test {

constexpr double flux = 0.012;
constexpr double kappa = 0.05;

class FluxLawEverywhere : public ::testing::TestWithParam<model::SchemeCase> {};
INSTANTIATE_TEST_SUITE_P(Schemes, FluxLawEverywhere,
                         ::testing::Values(model::explicit_scheme, model::implicit_scheme,
                                           model::implicit_one_second),
                         [](const auto& param_info) { return param_info.param.name; });

/// Largest error of the porosity of solid points, relative to the erodible 0.1.
template <class Run>
double porosity_error(Run& run, const std::vector<double>& times) {
  const auto moments = run.run(times);
  double worst = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double exact = 0.4 - 0.1 * std::exp(-kappa * (times[k] - 2.0));
    for (const double n : moments.states[k].porosity) {
      worst = std::max(worst, std::abs(n - exact) / 0.1);
    }
  }
  EXPECT_LE(run.worst_residual(), 1e-12);
  return worst;
}

TEST_P(FluxLawEverywhere, UniformFluxMakesItTheFirstOrderLaw) {
  const std::vector<double> times{7.0, 12.0, 22.0};
  // Water that expands by p / K on its way flows faster further down, and erodes faster.
  const double expansion = flux / 2e-2 * 9810.0 / 2e7;
  Scene scene = model::paper_scene();
  scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
  scene.initial_flow = InitialFlow::steady;
  scene.soils[0].erosion = {erosion_law("flux"), kappa / flux, 2.0, false};
  scene.time.end = times.back();
  GetParam().apply(scene);
  model::ModelRun single(model::make_case(model::column_mesh(4, 4), scene));
  const double single_error = porosity_error(single, times);

  Scene points = model::double_point_scene(flux, 0.0);
  points.soils.front().erosion = scene.soils[0].erosion;
  points.time.end = times.back();
  GetParam().apply(points);
  model::DoublePointRun both(model::make_double_point_case(model::layered_mesh(4, {}), points));
  const double double_error = porosity_error(both, times);
  std::cout << GetParam().name << ": porosity off by " << single_error << " (single-point), "
            << double_error << " (double-point) of what can erode\n";
  EXPECT_LE(single_error, expansion);
  EXPECT_LE(double_error, expansion);
}

TEST(PermeabilityFeedbackDoublePoint, FluxVolumeAndFinesFollowTheExactSolution) {
  std::vector<double> times;
  std::vector<ReferenceRow> rows;
  for (const auto& row : read_reference("permeability-feedback.csv")) {
    if (row.number("alpha") != 5e-3 || row.number("t") > 42.0) continue;
    times.push_back(row.number("t"));
    rows.push_back(row);
  }
  Scene scene = model::double_point_scene(flux, 5e-3);
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils.front().conductivity_law = conductivity_law("kozeny-carman");
  scene.boundaries = {model::pressure_on("inflow", 5886.0), model::pressure_on("outflow", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  scene.time.inertia = false;
  scene.time.end = times.back();
  model::implicit_one_second.apply(scene);
  constexpr int cells = 8;
  model::DoublePointRun run(model::make_double_point_case(model::layered_mesh(cells, {}), scene));
  const auto moments = run.run(times);
  double flux_error = 0.0;
  double volume_error = 0.0;
  double out_error = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const HistoryRow history = moments.states[k].history;
    const LedgerRow ledger = moments.states[k].ledger;
    flux_error = std::max(flux_error, std::abs(history.flux_in / rows[k].number("q") - 1.0));
    // Liquid enters in whole points, so the volume is off by less than one point per face.
    const double volume = 2.0 * flux + rows[k].number("V_cum_since_t0");
    volume_error = std::max(volume_error, std::abs(ledger.water_in / 1000.0 - volume));
    out_error = std::max(out_error, std::abs(ledger.fines_out - rows[k].number("M_eroded_out")));
  }
  const double points_in_the_air = cells * 0.3 / (cells * cells * 2.0 * 12.0);
  std::cout << "double-point feedback: errors of flux " << flux_error << ", volume " << volume_error
            << " m3 (one point per face: " << points_in_the_air << "), fines out "
            << out_error / 270.0 << " of the erodible mass\n";
  EXPECT_LE(flux_error, 1e-3);
  EXPECT_LE(volume_error, points_in_the_air);
  EXPECT_LE(out_error, 5e-3 * 270.0);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

}  // namespace coupled_erosion_test
}  // namespace suffuse
