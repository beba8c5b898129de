/// Drives of erosion where porosity is uniform, so that the solution follows from an ordinary
/// differential equation: drives that grow as erosion opens pores, a threshold that is crossed
/// within a step, residuals that depend on the flux; and a suspension that makes the liquid
/// viscous.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "model_run.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace erosion_drives_test {

constexpr double weight = 1000.0 * 9.81;

Scene driven_scene(const char* law, const char* drive, double rate, double end) {
  Scene scene = model::paper_scene();
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils[0].erosion.law = erosion_law(law);
  scene.soils[0].erosion.drive = drive_law(drive);
  scene.soils[0].erosion.rate = rate;
  scene.initial_flow = InitialFlow::steady;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::second_order;
  scene.time.tolerance = 1e-4;
  scene.time.inertia = false;  // the differential equations have no inertia
  scene.time.end = end;
  scene.output.every = scene.output.snapshot_every = end;
  return scene;
}

/// Clean water of this head on top of a column of one metre.
void set_head(Scene& scene, const TimeFunction& head) {
  TimeFunction pressure = head;
  for (auto& [time, value] : pressure.knots) value *= weight;
  scene.boundaries = {model::pressure_on("top", 0.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].pressure = pressure;
  scene.boundaries[0].concentration = 0.0;
}

/// Largest error of the porosity at the times of a column of a table.
double porosity_error(const Scene& scene, const std::vector<double>& times,
                      const std::vector<double>& exact) {
  model::ModelRun run(model::make_case(model::column_mesh(2, 4), scene));
  const auto moments = run.run(times);
  double worst = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    for (const double n : moments.states[k].porosity) {
      worst = std::max(worst, std::abs(n - exact[k]));
    }
  }
  EXPECT_LE(run.worst_residual(), 1e-12);
  std::cout << "error " << worst << " in " << run.steps() << " steps\n";
  return worst;
}

struct FeedbackCase {
  const char* column;
  const char* law;
  const char* drive;
  double rate;
  double threshold;
  double gradient;
  double accuracy;  ///< with steps by a tolerance of 1e-4
  double step;      ///< longest step in the range of the order, s
};

constexpr double porosity = 0.3;
constexpr double conductivity = 2e-2;
/// Gradients at which the shear stress is 2 Pa and the power 72 W/m3 at the start.
const double gradient_of_shear = 2.0 / std::sqrt(2.0 * conductivity * 1e-3 * weight / porosity);
const double gradient_of_power = std::sqrt(72.0 / (weight * conductivity));

class DrivesWithFeedback : public ::testing::TestWithParam<FeedbackCase> {
 protected:
  static double error(double step) {
    const FeedbackCase& c = GetParam();
    std::vector<double> times;
    std::vector<double> exact;
    for (const ReferenceRow& row : read_reference("erosion-drives-with-feedback.csv")) {
      times.push_back(row.number("t"));
      exact.push_back(row.number(c.column));
    }
    Scene scene = driven_scene(c.law, c.drive, c.rate, times.back());
    scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
    scene.soils[0].erosion.threshold = c.threshold;
    set_head(scene, c.gradient);
    if (step > 0.0) scene.time.step = step;
    return porosity_error(scene, times, exact);
  }
};

TEST_P(DrivesWithFeedback, FollowTheTable) {
  EXPECT_LT(error(0.0), GetParam().accuracy);
}

TEST_P(DrivesWithFeedback, AreOfSecondOrder) {
  const double coarse = error(GetParam().step);
  const double fine = error(0.5 * GetParam().step);
  EXPECT_GT(std::log2(coarse / fine), 1.9) << coarse << ' ' << fine;
}

INSTANTIATE_TEST_SUITE_P(
    Drives, DrivesWithFeedback,
    ::testing::Values(FeedbackCase{"n_shear", "first-order", "shear-stress", 1e-2, 0.5,
                                   gradient_of_shear, 1e-6, 1.0},
                      FeedbackCase{"n_flux", "first-order", "flux", 2.0, 0.0, 0.6, 1e-6, 1.0},
                      FeedbackCase{"n_power", "constant", "power", 1e-5, 0.0, gradient_of_power,
                                   2e-6, 0.25}),
    [](const auto& param_info) { return std::string(param_info.param.column); });

TEST(Threshold, IsCrossedWithinAStep) {
  Scene scene = driven_scene("first-order", "gradient", 0.02, 100.0);
  scene.soils[0].erosion.threshold = 0.35;
  set_head(scene, TimeFunction({{0.0, 0.0}, {100.0, 1.0}}));
  std::vector<double> times;
  std::vector<double> exact;
  for (const ReferenceRow& row : read_reference("erosion-threshold-ramp.csv")) {
    times.push_back(row.number("t"));
    exact.push_back(row.number("n_L"));
  }
  EXPECT_LT(porosity_error(scene, times, exact), 1e-6);
  scene.time.step = 20.0;
  EXPECT_LT(porosity_error(scene, times, exact), 1e-6);
}

TEST(Residual, GoesWithTheFlux) {
  Scene scene = driven_scene("first-order", "flux", 5.0, 1200.0);
  scene.soils[0].erosion.residual.pairs = {{1e-3, 0.08}, {3e-3, 0.05}, {1e-2, 0.01}};
  std::vector<double> times;
  std::vector<double> exact;
  double first = 0.0;
  for (const ReferenceRow& row : read_reference("erosion-residual-stages.csv")) {
    if (row.number("t") == 0.0) {
      first = row.number("n_L");
      continue;
    }
    times.push_back(row.number("t"));
    exact.push_back(row.number("n_L"));
  }
  scene.soils[0].porosity = first;
  const double jump = 1e-6;
  scene.boundaries = {model::flux_on("top", 0.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].darcy_flux = TimeFunction({{300.0, 1e-3},
                                                 {300.0 + jump, 3e-3},
                                                 {600.0, 3e-3},
                                                 {600.0 + jump, 1e-3},
                                                 {900.0, 1e-3},
                                                 {900.0 + jump, 1e-2}});
  EXPECT_LT(porosity_error(scene, times, exact), 1e-6);
}

TEST(Suspension, PushesCleanWaterOut) {
  Scene scene = driven_scene("none", "time", 0.0, 30.0);
  scene.liquid.viscosity_model = {viscosity_laws()[1], 0.62};
  set_head(scene, 0.6);
  scene.boundaries[0].concentration = 0.1;
  model::ModelRun run(model::make_case(model::column_mesh(2, 64, 1.0 / 32, 1.0), scene));
  std::vector<double> times;
  std::vector<double> fronts;
  std::vector<double> fluxes;
  for (const ReferenceRow& row : read_reference("suspension-front.csv")) {
    times.push_back(row.number("t"));
    fronts.push_back(row.number("x_front"));
    fluxes.push_back(row.number("q"));
  }
  const auto moments = run.run(times);
  const double width = 1.0 / 32;
  for (std::size_t k = 0; k < times.size(); ++k) {
    // The place of a sharp front that holds the same fines.
    const LedgerRow& ledger = moments.states[k].ledger;
    const double front = (ledger.fines + ledger.fines_out) / (2700.0 * 0.1 * 0.3 * width);
    const double flux = moments.states[k].history.flux_in / width;
    std::cout << times[k] << ": front " << front / fronts[k] - 1.0 << ", flux "
              << flux / fluxes[k] - 1.0 << '\n';
    if (fronts[k] < 1.0) {
      EXPECT_NEAR(front, fronts[k], 0.005 * fronts[k]) << times[k];
    }
    EXPECT_NEAR(flux, fluxes[k], 0.005 * fluxes[k]) << times[k];
  }
  EXPECT_LE(run.worst_residual(), 1e-12);
  std::cout << run.steps() << " steps\n";
}

/// Where the conductivity varies, the gradient at a place follows from the conductivity there,
/// however the fines are transported.
TEST(RandomField, ErodesAlikeWithEitherTransport) {
  Scene scene = driven_scene("first-order", "gradient", 1e-3, 20.0);
  scene.soils[0].field = {.variation = 1.0, .along = 0.4, .across = 0.4, .seed = 3};
  set_head(scene, 0.6);
  const auto eroded = [&](TransportScheme transport) {
    scene.time.transport = transport;
    model::ModelRun run(model::make_case(model::column_mesh(8, 8), scene));
    const double result = run.run({scene.time.end}).states.back().ledger.eroded;
    EXPECT_LE(run.worst_residual(), 1e-12);
    return result;
  };
  const double by_steps = eroded(TransportScheme::explicit_steps);
  EXPECT_GT(by_steps, 0.1);
  EXPECT_NEAR(eroded(TransportScheme::implicit_sweeps), by_steps, 1e-6 * by_steps);
}

}  // namespace erosion_drives_test
}  // namespace suffuse
