/// The single-point formulation with implicit flow: coupling of flow and erosion in both
/// directions, steps by tolerance, events, soils and waters of any stiffness, and a flow that is
/// not solved while it does not change.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "grid/face_flux.hpp"
#include "model_run.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace implicit_single_point_test {

constexpr double stiff = std::numeric_limits<double>::infinity();
constexpr double head = 5886.0;  ///< Pa over one metre: a gradient of 0.6

Scene implicit_scene(double end) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = end;
  scene.initial_flow = InitialFlow::steady;
  return scene;
}

Scene under_head(double end) {
  Scene scene = implicit_scene(end);
  scene.boundaries = {model::pressure_on("top", head), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  return scene;
}

Mesh<2> strip(int cells) {
  return model::column_mesh(2, cells, 2.0 / cells, 1.0);
}

double width_of(const Mesh<2>& mesh) {
  double width = 0.0;
  for (const Vector<2>& x : mesh.nodes) width = std::max(width, x[0]);
  return width;
}

long calls_of(const std::vector<PassTiming>& passes, const std::string& name) {
  for (const PassTiming& pass : passes) {
    if (pass.name == name) return pass.calls;
  }
  ADD_FAILURE() << "no pass " << name;
  return -1;
}

/// Mean of n_f over the width at depth x, from the elements that hold it.
double fines_at_depth(const Mesh<2>& mesh, const model::ModelState<SinglePoint>& state, double x) {
  double sum = 0.0;
  int count = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    double low = 1e9;
    double high = -1e9;
    for (const int i : mesh.elements[e]) {
      low = std::min(low, 1.0 - mesh.nodes[i][1]);
      high = std::max(high, 1.0 - mesh.nodes[i][1]);
    }
    if (x < low - 1e-12 || x > high + 1e-12) continue;
    ElementValues<2> c;
    double volume = 0.0;
    for (int j = 0; j < 3; ++j) {
      c[j] = state.liquid.fines_volume[e][j] / state.liquid.liquid_volume[e][j];
      volume += state.liquid.liquid_volume[e][j];
    }
    // Each element has one horizontal edge and its fields do not vary across, so the value at depth
    // x lies on the line from that edge to the opposite vertex.
    const ElementValues<2> at = FieldNodes<2>::at_vertices(c);
    double top = 0.0;
    double bottom = 0.0;
    int tops = 0;
    for (int k = 0; k < 3; ++k) {
      const bool is_top = std::abs(1.0 - mesh.nodes[mesh.elements[e][k]][1] - low) < 1e-9;
      (is_top ? top : bottom) += at[k];
      tops += is_top ? 1 : 0;
    }
    const double share = (x - low) / (high - low);
    const double value = (1.0 - share) * top / tops + share * bottom / (3 - tops);
    double area = 0.0;
    {
      const auto& n = mesh.elements[e];
      const Vector<2> a = mesh.nodes[n[1]] - mesh.nodes[n[0]];
      const Vector<2> b = mesh.nodes[n[2]] - mesh.nodes[n[0]];
      area = 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]);
    }
    sum += value * volume / area;
    ++count;
  }
  return sum / count;
}

struct FeedbackCase {
  const char* name;
  double rate;
  std::optional<double> step;
  double tolerance;
};

class ImplicitPermeabilityFeedback : public ::testing::TestWithParam<FeedbackCase> {};

TEST_P(ImplicitPermeabilityFeedback, FluxVolumeAndFinesFollowTheExactSolution) {
  const FeedbackCase& feedback = GetParam();
  std::vector<double> times;
  std::vector<ReferenceRow> rows;
  for (const auto& row : read_reference("permeability-feedback.csv")) {
    const double t = row.number("t");
    if (row.number("alpha") != feedback.rate || t > (feedback.rate < 2e-3 ? 112.0 : 42.0)) continue;
    times.push_back(t);
    rows.push_back(row);
  }
  ASSERT_GE(rows.size(), 7U);
  Scene scene = under_head(times.back());
  scene.liquid.bulk_modulus = stiff;
  scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
  scene.soils[0].erosion = {erosion_law("constant"), feedback.rate, 2.0, false};
  scene.time.step = feedback.step;
  scene.time.inertia = false;  // the exact solution has none either
  scene.time.tolerance = feedback.tolerance;
  model::ModelRun run(model::make_case(strip(64), scene));
  const double width = width_of(run.input().mesh);
  const auto moments = run.run(times);
  double flux_error = 0.0;
  double volume_error = 0.0;
  double fines_error = 0.0;
  double out_error = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ReferenceRow& row = rows[k];
    const HistoryRow history = moments.states[k].history;
    const LedgerRow ledger = moments.states[k].ledger;
    flux_error = std::max(flux_error, std::abs(history.flux_in / width / row.number("q") - 1.0));
    const double volume = 2.0 * 0.012 + row.number("V_cum_since_t0");
    volume_error =
        std::max(volume_error, std::abs(ledger.water_in / 1000.0 / width / volume - 1.0));
    out_error = std::max(out_error,
                         std::abs(ledger.fines_out / width - row.number("M_eroded_out")) / 270.0);
    // Close to the fronts from the start and the end of erosion, n_f has kinks whose error depends
    // on the mesh.
    const double since_exhaustion = row.number("t") - 2.0 - 0.1 / feedback.rate;
    const double tail = since_exhaustion * row.number("q") / row.number("n_L");
    for (const double x : {0.5, 1.0}) {
      if (std::abs(x - row.number("front_x")) < 0.05 || std::abs(x - tail) < 0.05) continue;
      const double exact = row.number(x < 0.75 ? "n_f(0.5)" : "n_f(1)");
      fines_error =
          std::max(fines_error,
                   std::abs(fines_at_depth(run.input().mesh, moments.states[k], x) - exact) / 0.1);
    }
  }
  std::cout << feedback.name << ": errors of flux " << flux_error << ", volume " << volume_error
            << ", n_f " << fines_error << ", fines out " << out_error << " in " << run.steps()
            << " steps\n";
  EXPECT_LE(flux_error, 1e-3);
  EXPECT_LE(volume_error, 1e-3);
  EXPECT_LE(fines_error, 1e-3);
  EXPECT_LE(out_error, 1e-3);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Laws, ImplicitPermeabilityFeedback,
                         ::testing::Values(FeedbackCase{"slow_one_second", 1e-3, 1.0, 1e-3},
                                           FeedbackCase{"slow_tolerance", 1e-3, {}, 1e-3},
                                           FeedbackCase{"fast_one_second", 5e-3, 1.0, 1e-3},
                                           FeedbackCase{"fast_tolerance", 5e-3, {}, 1e-3}),
                         [](const auto& param_info) { return param_info.param.name; });

TEST(ImplicitPermeabilityFeedback, ItsErrorFallsWithTheSquareOfTheStep) {
  // Volume at the outlet up to t = 22 s, on a coarse mesh: errors in space have no effect on it.
  double exact = 0.0;
  for (const auto& row : read_reference("permeability-feedback.csv")) {
    if (row.number("alpha") == 5e-3 && row.number("t") == 22.0) {
      exact = 2.0 * 0.012 + row.number("V_cum_since_t0");
    }
  }
  const auto error = [&](double step, TimeStepping stepping) {
    Scene scene = under_head(22.0);
    scene.liquid.bulk_modulus = stiff;
    scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
    scene.soils[0].erosion = {erosion_law("constant"), 5e-3, 2.0, false};
    scene.time.step = step;
    scene.time.inertia = false;
    scene.time.stepping = stepping;
    model::ModelRun run(model::make_case(model::column_mesh(4, 4), scene));
    const auto moments = run.run({22.0});
    return std::abs(moments.states[0].ledger.water_in / 1000.0 - exact) / exact;
  };
  for (const auto& [stepping, order] :
       {std::pair{TimeStepping::second_order, 2.0}, std::pair{TimeStepping::monotone, 1.0}}) {
    const double coarse = error(2.0, stepping);
    const double fine = error(0.5, stepping);
    const double measured = 0.5 * std::log2(coarse / fine);
    std::cout << "order " << measured << ", errors " << coarse << ", " << fine << '\n';
    EXPECT_NEAR(measured, order, 0.15);
  }
}

TEST(FluxLaw, UniformFluxMakesItTheFirstOrderLaw) {
  constexpr double flux = 0.012;
  constexpr double kappa = 0.05;
  std::map<double, std::vector<ReferenceRow>> tables;
  for (const auto& row : read_reference("fines-profile-first-order-law.csv")) {
    if (row.number("kappa") == kappa && row.number("q") == flux) {
      tables[row.number("t")].push_back(row);
    }
  }
  std::vector<double> times;
  for (const auto& [t, rows] : tables) times.push_back(t);
  ASSERT_GE(times.size(), 3U);
  Scene scene = implicit_scene(times.back());
  scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
  scene.liquid.bulk_modulus = stiff;
  scene.soils[0].erosion = {erosion_law("flux"), kappa / flux, 2.0, false};
  model::ModelRun run(model::make_case(strip(32), scene));
  const auto moments = run.run(times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    double error = 0.0;
    double scale = 0.0;
    for (const ReferenceRow& row : tables.at(times[k])) {
      for (const double n : moments.states[k].porosity) {
        EXPECT_NEAR(n, row.number("n_L"), 1e-11);
      }
      error += std::abs(fines_at_depth(run.input().mesh, moments.states[k], row.number("x")) -
                        row.number("n_f"));
      scale += row.number("n_f");
    }
    std::cout << "flux law, t = " << times[k] << " s: relative L1 error of n_f " << error / scale
              << '\n';
    EXPECT_LE(error, 0.01 * scale);
  }
  EXPECT_LE(run.worst_residual(), 1e-12);
}

TEST(FluxLaw, ErosionFollowsAFluxThatChanges) {
  // q(t) = 0.012 t / 10 from 0 to 10 s: lambda integral q dt is known.
  Scene scene = implicit_scene(10.0);
  scene.boundaries = {model::flux_on("top", 0.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].darcy_flux =
      TimeFunction(std::vector<std::pair<double, double>>{{0.0, 0.0}, {10.0, 0.012}});
  scene.liquid.bulk_modulus = stiff;
  scene.soils[0].erosion = {erosion_law("flux"), 20.0, 0.0, false};
  model::ModelRun run(model::make_case(model::column_mesh(2, 4), scene));
  const auto moments = run.run({5.0, 10.0});
  for (std::size_t k = 0; k < 2; ++k) {
    const double t = 5.0 * static_cast<double>(k + 1);
    const double exact = 0.4 - 0.1 * std::exp(-20.0 * 0.012 * t * t / 20.0);
    for (const double n : moments.states[k].porosity) EXPECT_NEAR(n, exact, 1e-4 * 0.1);
    EXPECT_NEAR(moments.states[k].ledger.water_in, 1000.0 * 0.012 * t * t / 20.0, 1e-4);
  }
}

TEST(Breakpoints, KinksOfBoundaryValuesAndErosionAreHitExactly) {
  // Inflow has its kinks, and erosion its start and end, at odd times: if steps end at all of them,
  // the inflow and the eroded mass are exact.
  Scene scene = implicit_scene(20.0);
  scene.boundaries = {model::flux_on("top", 0.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].darcy_flux = TimeFunction(std::vector<std::pair<double, double>>{
      {1.7, 0.0}, {3.1, 0.012}, {11.9, 0.012}, {12.3, 0.004}});
  scene.liquid.bulk_modulus = stiff;
  scene.soils[0].erosion = {erosion_law("constant"), 0.02, 2.3, false};
  scene.time.inertia = false;
  const double volume = 0.012 * (0.5 * 1.4 + 8.8 + 0.4) - 0.5 * 0.4 * 0.008 + 0.004 * 7.7;
  for (const std::optional<double> step : {std::optional<double>{}, std::optional<double>{1.0}}) {
    scene.time.step = step;
    model::ModelRun run(model::make_case(model::column_mesh(2, 4), scene));
    const auto moments = run.run({20.0});
    const LedgerRow row = moments.states[0].ledger;
    EXPECT_NEAR(row.water_in / 1000.0, volume, 1e-13);
    EXPECT_LE(run.worst_residual(), 1e-12);
    for (const double n : moments.states[0].porosity) EXPECT_NEAR(n, 0.4, 1e-15);
  }
}

TEST(StartUp, ToleranceBoundsTheError) {
  // Mean velocity P / (rho L) tau (1 - exp(-t / tau)), exact for any compressibility.
  constexpr double tau = 2e-2 / (0.3 * 9.81);
  const auto error = [&](double tolerance, long& steps) {
    Scene scene = under_head(6.0 * tau);
    scene.initial_flow = InitialFlow::rest;
    scene.time.inertia = true;
    scene.time.tolerance = tolerance;
    model::ModelRun run(model::make_case(model::column_mesh(4, 4), scene));
    std::vector<double> times;
    for (int k = 1; k <= 12; ++k) times.push_back(0.5 * k * tau);
    const auto moments = run.run(times);
    double worst = 0.0;
    const Grid<2> grid(run.input().mesh);
    for (std::size_t k = 0; k < times.size(); ++k) {
      Vector<2> mean = Vector<2>::Zero();
      for (int e = 0; e < grid.mesh.element_count(); ++e) {
        mean += grid.volume[e] / 0.3 *
                flux_at(grid, moments.flows[k].face_flux, e, element_centroid(grid.mesh, e));
      }
      const double exact = head / 1000.0 * tau * (1.0 - std::exp(-times[k] / tau));
      worst = std::max(worst, std::abs(-mean[1] - exact) / (head / 1000.0 * tau));
    }
    steps = run.steps();
    return worst;
  };
  long last_steps = 0;
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    long steps = 0;
    const double worst = error(tolerance, steps);
    std::cout << "start-up, tolerance " << tolerance << ": error " << worst << " in " << steps
              << " steps\n";
    EXPECT_LE(worst, tolerance);
    // The order is two: an error ten times smaller needs sqrt(10) times as many steps.
    if (last_steps > 0) {
      EXPECT_NEAR(static_cast<double>(steps) / static_cast<double>(last_steps), 3.16, 0.6);
    }
    last_steps = steps;
  }
}

TEST(StartUp, WavesThatMoveNothingAreNotFollowed) {
  // Waves take 0.13 ms, drag takes 7 ms: the volume is that of the start-up alone, which is exact.
  constexpr double tau = 2e-2 / (0.3 * 9.81);
  constexpr double height = 0.05;
  constexpr double end = 0.5;
  const auto error = [&](double tolerance, std::optional<bool> inertia, long& steps) {
    Scene scene = under_head(end);
    scene.boundaries[0] = model::pressure_on("top", height * head);
    scene.boundaries[0].concentration = 0.0;
    scene.initial_flow = InitialFlow::rest;
    scene.liquid.bulk_modulus = 2.2e9;
    scene.time.tolerance = tolerance;
    scene.time.inertia = inertia;
    const Mesh<2> mesh = model::column_mesh(2, 4, 2.0 * height, height);
    model::ModelRun run(model::make_case(mesh, scene));
    double worst = 0.0;
    const std::vector<double> times{0.2 * end, 0.5 * end, end};
    const auto moments = run.run(times);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double time = times[k];
      const double exact =
          0.3 * width_of(mesh) * head / 1000.0 * tau * (time - tau * (1.0 - std::exp(-time / tau)));
      const double flowed = moments.states[k].ledger.water_out / 1000.0;
      worst = std::max(worst, std::abs(flowed - exact) / (exact / time * end));
    }
    steps = run.steps();
    EXPECT_LE(run.worst_residual(), 1e-12);
    return worst;
  };
  for (const double tolerance : {1e-2, 1e-3}) {
    long few = 0;
    long many = 0;
    const double passed_over = error(tolerance, std::nullopt, few);
    const double followed = error(tolerance, true, many);
    std::cout << "waves, tolerance " << tolerance << ": error " << passed_over << " in " << few
              << " steps; followed " << followed << " in " << many << "\n";
    EXPECT_LE(passed_over, tolerance);
    EXPECT_LE(few, many / 10);
  }
}

TEST(KeptFlow, SteadyFlowIsNotSolvedAgain) {
  Scene scene = under_head(120.0);
  scene.initial_flow = InitialFlow::rest;
  scene.soils[0].erosion = {erosion_law("constant"), 5e-3, 2.0, false};
  scene.time.step = 1.0;
  scene.time.inertia = false;
  model::ModelRun kept(model::make_case(model::column_mesh(4, 4), scene));
  const auto with = kept.run({60.0, 120.0});
  const auto passes = kept.model().passes();
  EXPECT_LE(calls_of(passes, "flow"), 20);
  EXPECT_EQ(calls_of(passes, "flow") + calls_of(passes, "flow, steady and kept"), 120);

  model::ModelRun solved(model::make_case(model::column_mesh(4, 4), scene), {1, true});
  const auto without = solved.run({60.0, 120.0});
  EXPECT_EQ(calls_of(solved.model().passes(), "flow"), 120);
  for (std::size_t k = 0; k < 2; ++k) {
    const LedgerRow a = with.states[k].ledger;
    const LedgerRow b = without.states[k].ledger;
    const double bar = 0.1 * scene.time.tolerance;
    EXPECT_NEAR(a.water_in, b.water_in, bar * b.water_in);
    EXPECT_NEAR(a.fines_out, b.fines_out, bar * b.eroded);
    EXPECT_NEAR(a.fines, b.fines, bar * b.eroded);
    EXPECT_NEAR(a.eroded, b.eroded, 1e-12 * b.eroded);
  }
}

}  // namespace implicit_single_point_test
}  // namespace suffuse
