/// Boundary values that change in time.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "driver/row_checks.hpp"
#include "flow/flow_scales.hpp"
#include "model_run.hpp"

namespace suffuse {
namespace boundary_values_test {

using Knots = std::vector<std::pair<double, double>>;

/// Mean downward velocity in a column one metre high: u' = p_top(t) / (rho L) - u / tau, for any
/// bulk modulus, in closed form between the knots.
double exact_mean_velocity(const Knots& pressure, double tau, double t) {
  double u = 0.0;
  for (std::size_t k = 0; k + 1 < pressure.size(); ++k) {
    const double from = pressure[k].first;
    const double p = pressure[k].second;
    if (t <= from) break;
    const double slope = (pressure[k + 1].second - p) / (pressure[k + 1].first - from);
    const double s = std::min(t, pressure[k + 1].first) - from;
    const auto followed = [&](double x) { return tau / 1000.0 * (p + slope * (x - tau)); };
    u = followed(s) + (u - followed(0.0)) * std::exp(-s / tau);
  }
  return u;
}

double mean_velocity(const Case<2>& c, const FlowState<2>& flow) {
  const Grid<2> grid(c.mesh);
  double sum = 0.0;
  for (std::size_t i = 0; i < flow.velocity.size(); ++i) {
    sum -= grid.node_volume[i] * flow.velocity[i][1];
  }
  return sum;
}

/// A pressure that changes until the end of the run: its later values bound pressures too.
TEST(BoundaryPressure, BoundsPressuresUntilTheEnd) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::monotone;
  scene.time.inertia = false;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.time.end = 10.0;
  scene.boundaries = {model::pressure_on("top", 0.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].pressure = TimeFunction(Knots{{0.0, 6000.0}, {10.0, -6000.0}});
  model::ModelRun run(model::make_case(model::column_mesh(2, 4), scene));
  const auto moments = run.run({5.0, 7.5, 10.0});
  for (const FlowState<2>& flow : moments.flows) EXPECT_LE(flow.pressure_overshoot, 1e-10);
}

/// Warnings of the rows of a run between 6 kPa on top and 0 on the bottom, through two layers whose
/// conductivities have a ratio of 1e4, on a square whose nodes are moved.
std::vector<std::string> warnings_of_layers(const std::function<Vector<2>(const Vector<2>&)>& move,
                                            double bulk_modulus = 2e7) {
  Mesh<2> mesh = model::column_mesh(8, 8, 1.0, 1.0, move);
  mesh.region_names.emplace_back("upper");
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 0.5 ? 1 : 0;
  }
  Scene scene = model::paper_scene();
  scene.soils.push_back(scene.soils[0]);
  scene.soils[1].region = "upper";
  scene.soils[1].conductivity *= 1e-4;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::monotone;
  scene.liquid.bulk_modulus = bulk_modulus;
  scene.time.inertia = false;
  scene.time.end = 1.0;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  model::ModelRun run(model::make_case(mesh, scene));
  RowChecks checks(run.input().document.scene, run.plan().row_limits);
  std::vector<std::string> warnings;
  for (const auto& state : run.run({0.01, 0.1, 0.5, 1.0}).states) {
    for (const std::string& warning : checks.check(state.history)) warnings.push_back(warning);
  }
  return warnings;
}

TEST(ObtuseAngles, AreWarnedOfWherePressuresLeaveTheirBounds) {
  EXPECT_TRUE(warnings_of_layers([](const Vector<2>& x) { return x; }).empty());
  // Rows of inner nodes are moved to and fro: angles become obtuse, and layers follow the mesh.
  const auto bent = [](const Vector<2>& x) {
    const double way = std::lround(8.0 * x[1]) % 2 == 0 ? 0.2 : -0.2;
    return Vector<2>(x[0] + way * x[0] * (1.0 - x[0]), x[1]);
  };
  EXPECT_GT(obtuse_elements(Grid<2>(model::column_mesh(8, 8, 1.0, 1.0, bent))), 16);
  EXPECT_TRUE(warnings_of_layers(bent, std::numeric_limits<double>::infinity()).empty())
      << "steady";
  const auto warnings =
      warnings_of_layers([](const Vector<2>& x) { return Vector<2>(x[0] + 0.5 * x[1], x[1]); });
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].find("pressures lie outside those of boundaries and start, by "), 0U);
  EXPECT_NE(warnings[0].find("128 elements have one; mesh.structure = \"free\""), std::string::npos)
      << warnings[0];
  EXPECT_EQ(warnings[0].find("second order"), std::string::npos) << warnings[0];
}

/// Rest, a ramp within three times the settling time of the flow, a jump down, then constant.
TEST(BoundaryPressure, MovesTheColumnAsItChanges) {
  const Knots pressure{{0.0, 0.0},     {0.01, 0.0},       {0.03, 6000.0},
                       {0.04, 6000.0}, {0.04001, 2000.0}, {0.1, 2000.0}};
  const double tau = 2e-2 / (0.3 * 9.81);
  std::vector<double> times{0.009, 0.015, 0.02, 0.03, 0.035, 0.045, 0.05, 0.08};
  std::vector<double> errors;
  for (const double step : {4e-5, 1e-5}) {
    Scene scene = model::paper_scene();
    scene.boundaries = {model::pressure_on("top", 0.0), model::pressure_on("bottom", 0.0)};
    scene.boundaries[0].pressure = TimeFunction(pressure);
    scene.time.end = times.back();
    scene.time.step = step;
    model::ModelRun run(model::make_case(model::column_mesh(2, 8), scene));
    const auto moments = run.run(times);
    double worst = 0.0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      worst = std::max(worst, std::abs(mean_velocity(run.input(), moments.flows[k]) -
                                       exact_mean_velocity(pressure, tau, times[k])));
    }
    errors.push_back(worst / (6000.0 * tau / 1000.0));
    EXPECT_LT(run.worst_residual(), 1e-12);
  }
  std::cout << "mean velocity under a pressure that changes: largest error " << errors[0]
            << " of the steady one with steps of 40 us, " << errors[1] << " with 10 us\n";
  // First order, as drag is evaluated at one end of the step: half a step over the settling time.
  EXPECT_LT(errors[0], 0.5 * 4e-5 / tau);
  EXPECT_LT(errors[1], 0.5 * 1e-5 / tau);
}

/// Largest error of the mass of fines that flowed in, relative to all of it, against the integral
/// of c q. `knots`: times of both tables, at which the error is measured.
double error_of_fines_inflow(FlowScheme scheme, double step, const TimeFunction& flux,
                             const std::vector<double>& knots) {
  Scene scene = model::paper_scene();
  scene.boundaries = {model::flux_on("top", 0.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].darcy_flux = flux;
  const TimeFunction concentration(Knots{{0.5, 0.0}, {1.5, 0.1}, {2.5, 0.1}, {3.5, 0.02}});
  scene.boundaries[0].concentration = concentration;
  scene.time.end = knots.back();
  scene.time.scheme = scheme;
  scene.time.step = step;
  model::ModelRun run(model::make_case(model::column_mesh(2, 8), scene));
  const std::vector<double> times(knots.begin() + 1, knots.end());
  const auto moments = run.run(times);
  EXPECT_LT(run.worst_residual(), 1e-12);
  const auto product = [&](double t) { return flux.value(t) * concentration.value(t); };
  double volume = 0.0;
  double worst = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double from = knots[k];
    const double to = knots[k + 1];
    // Simpson's rule is exact for the product of two lines.
    volume += (to - from) / 6.0 * (product(from) + 4.0 * product(0.5 * (from + to)) + product(to));
    const double fines = moments.states[k].ledger.fines_in;
    worst = std::max(worst, std::abs(fines - 2700.0 * volume));
  }
  return worst / (2700.0 * volume);
}

/// Within an interval of the flow c has its mean value. This is exact if c or q is constant;
/// otherwise each interval of length D has an error of c' q' D^3 / 12. Intervals are at most 1000
/// steps of the explicit scheme, or one step of the implicit one.
void expect_the_integral(FlowScheme scheme, double step, double interval) {
  const std::vector<double> knots{0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 5.0};
  const double constant = error_of_fines_inflow(scheme, step, 0.012, knots);
  const double changing =
      error_of_fines_inflow(scheme, step, TimeFunction(Knots{{1.0, 0.004}, {2.0, 0.012}}), knots);
  std::cout << "fines that flowed in: largest error " << constant
            << " of all with a constant flux, " << changing << " with one that changes\n";
  EXPECT_LT(constant, 1e-6);
  const double both_change = 0.5;  // s, from 1 s to 1.5 s
  const double missed = 0.1 * 0.008 * interval * interval / 12.0 * both_change;
  EXPECT_LT(changing, missed / (0.012 * 0.2));  // more than 0.012 m/s 0.2 s flow in
}

TEST(BoundaryConcentration, BringsInTheIntegral) {
  expect_the_integral(FlowScheme::explicit_nodal, 1e-4, 1000 * 1e-4);
}

TEST(BoundaryConcentration, BringsInTheIntegralOfTheImplicitScheme) {
  expect_the_integral(FlowScheme::implicit_mixed, 0.05, 0.05);
}

/// A table that is constant in time is equivalent to a number.
TEST(BoundaryValues, OfALevelTableChangeNothing) {
  const auto flux_of = [](const TimeFunction& pressure) {
    Scene scene = model::paper_scene();
    scene.boundaries = {model::pressure_on("top", 0.0), model::pressure_on("bottom", 0.0)};
    scene.boundaries[0].pressure = pressure;
    scene.time.end = 0.05;
    model::ModelRun run(model::make_case(model::column_mesh(2, 4), scene));
    const auto moments = run.run({0.05});
    return moments.states[0].history.flux_in;
  };
  const double constant = flux_of(6000.0);
  EXPECT_GT(constant, 0.01);
  EXPECT_EQ(flux_of(TimeFunction(Knots{{0.01, 6000.0}, {0.02, 6000.0}})), constant);
  // A table that changes only after the end is treated as changing, with the same results.
  EXPECT_NEAR(flux_of(TimeFunction(Knots{{1.0, 6000.0}, {2.0, 0.0}})), constant, 1e-15);
}

/// The flux through the face follows the table of velocity at each time; walls stay closed.
TEST(BoundaryVelocity, CrossesTheFaceAsItChanges) {
  Scene scene = model::paper_scene();
  scene.boundaries = {model::flux_on("top", 0.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].darcy_flux.reset();
  scene.boundaries[0].velocity = TimeFunction(Knots{{0.0, 0.0}, {1.0, 0.04}, {1.5, 0.02}});
  scene.time.end = 2.0;
  model::ModelRun run(model::make_case(model::column_mesh(2, 8), scene));
  const std::vector<double> times{0.5, 1.25, 2.0};
  const auto moments = run.run(times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const HistoryRow row = moments.states[k].history;
    const double expected = 0.3 * scene.boundaries[0].velocity->value(times[k]);
    // The tolerance is the change of the flux within a step.
    EXPECT_NEAR(row.flux_in, expected, 0.3 * 0.04 * run.plan().flow.step) << times[k];
  }
}

}  // namespace boundary_values_test
}  // namespace suffuse
