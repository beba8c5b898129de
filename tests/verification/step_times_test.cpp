/// Steps of the implicit flow around sudden changes: late in long runs, at the start, and where
/// soil fails.

#include <gtest/gtest.h>

#include <iostream>
#include <sstream>

#include "reference_table.hpp"
#include "scene_run.hpp"

namespace suffuse {
namespace step_times_test {

constexpr double unit_weight = 1000.0 * 9.81;  // of water, N/m3

/// The number as in a scene, with all its digits.
std::string text_of(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  const std::string result = text.str();
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

/// A column of 1 m that water crosses from top to bottom.
constexpr const char* crossed_column = R"(formulation = "single-point"
geometry = {shape = "column", width = 0.5, height = 1.0}
mesh = {size = 0.125}
liquid = {density = 1000.0, bulk_modulus = 2e9, viscosity = 1e-3}
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 2e-2
[[boundary]]
on = "top"
pressure = 6e3
concentration = 0.0
[[boundary]]
on = "bottom"
pressure = 0.0
[time]
end = 1e12
[output]
every = 1e11
)";

/// Flux out of the column, m3/s.
double flux_at(double pressure) {
  return 0.5 * 2e-2 * pressure / unit_weight;
}

TEST(StepTimes, StartsHoweverFarTheEnd) {
  model::SceneRun<2> run(crossed_column, {});
  run.run_to(1e9);
  EXPECT_NEAR(run.history().flux_out / flux_at(6e3), 1.0, 1e-5);
  EXPECT_LT(run.worst_residual(), 1e-12);
}

/// Flux out in the middle of a ramp from 1 kPa to 6 kPa within a millisecond, at its end, and 10 s
/// later, relative to the steady one at 6 kPa.
std::vector<double> flux_around_ramp(double start, double end) {
  const double ramp = 1e-3;
  const std::string pressure = "boundary[0].pressure=[[0.0, 1e3], [" + text_of(start) +
                               ", 1e3], [" + text_of(start + ramp) + ", 6e3]]";
  model::SceneRun<2> run(crossed_column, {pressure, "time.end=" + text_of(end)});
  std::vector<double> result;
  for (const double after : {0.5 * ramp, ramp, 10.0}) {
    run.run_to(start + after);
    result.push_back(run.history().flux_out / flux_at(6e3));
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  return result;
}

TEST(StepTimes, RampsAreFollowedLateInALongRun) {
  const std::vector<double> early = flux_around_ramp(10.0, 20.0);
  const std::vector<double> late = flux_around_ramp(1e9, 3.1557e9);
  for (std::size_t i = 0; i < early.size(); ++i) {
    std::cout << "flux early " << early[i] << ", late " << late[i] << "\n";
    EXPECT_NEAR(late[i], early[i], 5e-3);
  }
  EXPECT_NEAR(late.back(), 1.0, 1e-4);
}

/// Two times that are nearly or exactly equal as doubles in sums of steps.
TEST(StepTimes, JumpsBetweenNeighbouringTimes) {
  for (const double width : {1.2e-7, 1e-6, 1e-5, 1e-4}) {
    const std::string pressure =
        "boundary[0].pressure=[[0.0, 1e3], [1e9, 1e3], [" + text_of(1e9 + width) + ", 6e3]]";
    model::SceneRun<2> run(crossed_column, {pressure, "time.end=3.1557e9"});
    run.run_to(1e9);
    EXPECT_NEAR(run.history().flux_out / flux_at(1e3), 1.0, 1e-4) << width;
    run.run_to(1e9 + 1.0);
    EXPECT_NEAR(run.history().flux_out / flux_at(6e3), 1.0, 1e-4) << width;
    EXPECT_LT(run.worst_residual(), 1e-12);
  }
}

/// Soil of 1 m that a load of 100 Pa consolidates; probes at 3/4, 1/2, 1/4 and 0 of its height.
constexpr const char* loaded_column = R"(formulation = "single-point"
geometry = {shape = "column", width = 0.0625, height = 1.0}
mesh = {size = 0.03125, structure = "crossed"}
liquid = {density = 1000.0, bulk_modulus = inf, viscosity = 1e-3}
[soil.specimen]
porosity = 0.4
skeleton_fraction = 0.6
grain_density = 2650.0
conductivity = 1e-6
skeleton = {law = "elastic", young = 9.81e6, poisson = 0.0}
[[boundary]]
on = "top"
pressure = 0.0
concentration = 0.0
traction = [[0.0, 0.0, 0.0], [1e-3, 0.0, -1e2]]
[[boundary]]
on = "bottom"
fix = "both"
[[boundary]]
on = "left"
fix = "normal"
[[boundary]]
on = "right"
fix = "normal"
[time]
end = 1e4
[output]
every = 100.0
[[output.probe]]
at = [0.03125, 0.75]
[[output.probe]]
at = [0.03125, 0.5]
[[output.probe]]
at = [0.03125, 0.25]
)";

/// Largest error of the pressure over the load, at T = 0.1 after a load that is applied within
/// `width` from `start` on.
double error_after_load(double start, double width, double tolerance) {
  constexpr double second = 1000.0;  // of T = 1
  std::string table = "boundary[0].traction=[[0.0, 0.0, 0.0], ";
  if (start > 0.0) table += "[" + text_of(start) + ", 0.0, 0.0], ";
  table += "[" + text_of(start + width) + ", 0.0, -1e2]]";
  model::SceneRun<2> run(loaded_column, {table, "time.tolerance=" + text_of(tolerance)});
  double error = 0.0;
  if (start > 0.0) run.run_to(start);
  for (const ReferenceRow& row : read_reference("terzaghi.csv")) {
    if (row.number("T") != 0.1) continue;
    run.run_to(start + 0.1 * second);
    const std::vector<double> pressure = run.probed();
    const char* const names[] = {"u(0.25)", "u(0.5)", "u(0.75)"};
    for (int i = 0; i < 3; ++i) {
      error = std::max(error, std::abs(pressure[i] / 1e2 - row.number(names[i])));
    }
  }
  EXPECT_LT(run.worst_residual(), 1e-12);
  std::cout << "load at " << start << " s within " << width << " s, tolerance " << tolerance
            << ": off by " << error << "\n";
  return error;
}

/// Compares the row at 1 % of the run.
TEST(StepTimes, ALoadThatComesAtOnceIsFollowedAtTheTolerance) {
  for (const double start : {0.0, 5e3}) {
    for (const double width : {1e-6, 1e-3, 0.1}) {
      const double coarse = error_after_load(start, width, 1e-2);
      const double fine = error_after_load(start, width, 1e-3);
      EXPECT_LT(coarse, 2e-2);
      EXPECT_LT(fine, 7e-3);
      EXPECT_LT(fine, 0.5 * coarse);
    }
  }
}

/// A block of clay between a rough base and a load that it cannot carry: the load is applied at
/// once after 10 s, and the soil fails.
constexpr const char* broken_block = R"(formulation = "single-point"
gravity = [0.0, -9.81]
geometry = {shape = "column", width = 1.0, height = 1.0}
mesh = {size = 0.25, structure = "crossed"}
liquid = {density = 1000.0, bulk_modulus = inf, viscosity = 1e-3}
initial.water_level = 1.0
[soil.specimen]
porosity = 0.4
skeleton_fraction = 0.6
grain_density = 2650.0
conductivity = 1e-6
skeleton = {law = "von-mises", young = 1e7, poisson = 0.25, cohesion = 2e4}
[[boundary]]
on = "top"
pressure = 0.0
concentration = 0.0
traction = [[0.0, 0.0, 0.0], [10.0, 0.0, -1e3], [10.00000005, 0.0, -2e5]]
[[boundary]]
on = "bottom"
fix = "both"
[[boundary]]
on = "left"
fix = "normal"
[time]
end = 100.0
failure = "follow"
[output]
every = 10.0
)";

TEST(StepTimes, AStepInWhichSoilFailsIsAsLongAsItWasSolvedFor) {
  const Case<2> c = model::case_of<2>(broken_block, {});
  const std::unique_ptr<TwoPhaseModel<2>> model = make_model(c, make_plan(c, {}));
  int after_failure = 0;
  while (after_failure < 5) {
    const double before = model->time();
    model->advance(20.0);
    ASSERT_LT(before, 20.0);
    EXPECT_NEAR(model->last_step(), model->time() - before, 1e-14 * 20.0) << "from t = " << before;
    if (model->solid().has_inertia()) ++after_failure;
    EXPECT_LT(std::abs(model->ledger().residual_water), 1e-12);
  }
  EXPECT_NEAR(model->time(), 10.0, 1e-3);
}

}  // namespace step_times_test
}  // namespace suffuse
