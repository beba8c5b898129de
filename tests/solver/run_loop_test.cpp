#include "driver/run_loop.hpp"

#include <gtest/gtest.h>

#include "common/errors.hpp"
#include "driver/plan.hpp"
#include "driver/row_checks.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace run_loop_test {

/// Stores the output that it gets.
class Notes final : public OutputSink<2> {
 public:
  explicit Notes(double stop_at = 1e9) : stop_at_(stop_at) {}
  void warn(const std::string& /*text*/) override {}
  void write_row(const FlowState<2>& flow) override {
    rows.push_back(flow.time);
    dt.push_back(flow.dt);
  }
  void write_snapshot(const FlowState<2>& flow) override { snapshots.push_back(flow.time); }
  bool continue_after_interval() override { return rows.back() < stop_at_; }

  std::vector<double> rows;
  std::vector<double> dt;
  std::vector<double> snapshots;

 private:
  double stop_at_;
};

Case<2> paper_step(FlowScheme scheme) {
  Scene scene = model::paper_scene();
  scene.time.scheme = scheme;
  scene.time.step = 0.0851;
  scene.time.mass_scaling = scheme == FlowScheme::explicit_nodal ? 1e4 : 1.0;
  scene.time.end = 4.0;
  scene.output.every = 1.0;
  scene.output.snapshot_every = 2.0;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  return model::make_case(model::column_mesh(4, 4), scene);
}

/// With the paper's step of 0.0851 s there are 12 equal steps from one row to the next.
TEST(RunLoop, OutputsEndStepsThatDivideTheTimeEvenly) {
  for (const FlowScheme scheme : {FlowScheme::explicit_nodal, FlowScheme::implicit_mixed}) {
    const Case<2> c = paper_step(scheme);
    RunLoop<2> loop(c, make_plan(c, {.threads = 1, .no_skip = true}));
    Notes notes;
    loop.run(notes);
    EXPECT_TRUE(loop.finished());
    EXPECT_EQ(notes.rows, (std::vector<double>{0.0, 1.0, 2.0, 3.0, 4.0}));
    EXPECT_EQ(notes.snapshots, (std::vector<double>{0.0, 2.0, 4.0}));
    EXPECT_EQ(loop.model().steps(), 48);
    for (std::size_t row = 1; row < notes.dt.size(); ++row) {
      EXPECT_NEAR(notes.dt[row], 1.0 / 12.0, 1e-14);
    }
  }
}

TEST(RunLoop, GoesOnWhereTheSinkStoppedIt) {
  const Case<2> c = paper_step(FlowScheme::explicit_nodal);
  const Plan plan = make_plan(c, {});
  RunLoop<2> whole(c, plan);
  Notes all;
  whole.run(all);

  RunLoop<2> stopped(c, plan);
  Notes first(2.0);
  stopped.run(first);
  EXPECT_EQ(first.rows, (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_FALSE(stopped.finished());
  const RestartPoint point = stopped.restart_point();
  EXPECT_EQ(point.time, 2.0);
  EXPECT_EQ(point.rows, 3);
  EXPECT_EQ(point.snapshots, 2);

  RunLoop<2> resumed(c, plan);
  StateArchive state(point.state);
  resumed.archive(state);
  Notes rest;
  resumed.run(rest);
  EXPECT_EQ(rest.rows, (std::vector<double>{3.0, 4.0})) << "no second row of t = 0";
  EXPECT_EQ(resumed.model().flow_state().pressure, whole.model().flow_state().pressure);
}

TEST(RowChecks, RefuseWhatTheEquationsDoNotDescribe) {
  Scene scene;
  scene.liquid.density = 1000.0;
  scene.liquid.bulk_modulus = 4e6;  // waves of 63 m/s
  scene.time.mass_scaling = 1.0;
  RowChecks checks(scene, {.speed_that_drag_follows = 5.0});
  HistoryRow row;
  row.pressure_max = 3e5;
  row.speed_max = 4.0;
  EXPECT_TRUE(checks.check(row).empty());
  row.pressure_min = -5e5;
  EXPECT_EQ(checks.check(row).size(), 1U) << "an eighth of the modulus";
  row.speed_max = 6.0;
  EXPECT_EQ(checks.check(row).size(), 1U) << "drag does not follow; the other was said before";
  scene.time.mass_scaling = 4.0;
  EXPECT_EQ(checks.check(row).size(), 1U) << "waves of 32 m/s";
  EXPECT_TRUE(checks.check(row).empty()) << "each once";
  row.pressure_scatter = 4e6;
  EXPECT_THROW(checks.check(row), NumericalError);
  row.pressure_scatter = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(checks.check(row), NumericalError);
}

TEST(RowChecks, SayWhatCanTakePressuresOutOfTheirBounds) {
  Scene scene;
  scene.liquid.density = 1000.0;
  scene.liquid.bulk_modulus = 4e6;
  const auto warning = [&](double overshoot, std::optional<int> obtuse) {
    RowChecks checks(scene, {.speed_that_drag_follows = 5.0, .obtuse_elements = obtuse});
    HistoryRow row;
    row.t = 2.0;
    row.pressure_overshoot = overshoot;
    const std::vector<std::string> warnings = checks.check(row);
    EXPECT_TRUE(checks.check(row).empty()) << "once";
    return warnings.empty() ? "" : warnings.front();
  };
  const std::string start =
      "pressures lie outside those of boundaries and start, by 3 % of their range at t = 2 s "
      "(pressure_overshoot); volumes and masses balance all the same.";
  const std::string angles =
      " Obtuse angles can do so, above all where conductivities differ: 7 elements have one; "
      "mesh.structure = \"free\", or \"regular\" for a column, makes few or none.";
  const std::string steps =
      " Long steps of second order can do so: time.stepping = \"monotone\", or a shorter "
      "time.step.";
  EXPECT_EQ(warning(0.03, 7), start + angles + steps);
  EXPECT_EQ(warning(0.03, 0), start + steps);
  EXPECT_EQ(warning(0.009, 7), "");
  EXPECT_EQ(warning(0.03, std::nullopt), "") << "waves go beyond by themselves";
  scene.time.stepping = TimeStepping::monotone;
  EXPECT_EQ(warning(0.03, 7), start + angles);
  EXPECT_EQ(warning(0.03, 0), "") << "nothing to change";
}

}  // namespace run_loop_test
}  // namespace suffuse
