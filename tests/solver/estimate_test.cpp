#include "tools/estimate.hpp"
#include "tools/rank_trial.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "case/case_file.hpp"
#include "driver/output_schedule.hpp"
#include "driver/run.hpp"
#include "files/number_text.hpp"
#include "mesher/temporary_folder.hpp"
#include "solver/double_point_case.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace estimate_test {

namespace fs = std::filesystem;
using test::TemporaryFolder;

Scene single_point_scene(FlowScheme scheme) {
  Scene scene = model::paper_scene();
  scene.soils[0].erosion.law = erosion_law("constant");
  scene.soils[0].erosion.rate = 5e-3;
  scene.soils[0].erosion.start = 2.0;
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  scene.time.scheme = scheme;
  scene.time.end = 40.0;
  scene.output.every = 0.5;
  return scene;
}

struct Example {
  std::string name;
  Case<2> input;
};

/// Small runs of both formulations and both schemes, with flow from rest and from the steady state,
/// and one whose flow changes until the end.
std::vector<Example> examples() {
  std::vector<Example> result;
  for (const FlowScheme scheme : {FlowScheme::explicit_nodal, FlowScheme::implicit_mixed}) {
    const bool implicit = scheme == FlowScheme::implicit_mixed;
    const std::string name = implicit ? "implicit" : "explicit";
    Scene scene = single_point_scene(scheme);
    result.push_back({"single-point, " + name, model::make_case(model::column_mesh(4, 4), scene)});
    scene.soils[0].conductivity_law = conductivity_law("kozeny-carman");
    scene.soils[0].erosion.law = erosion_law("logarithmic");
    scene.soils[0].erosion.rate = 1e-2;
    scene.soils[0].erosion.start = 0.0;
    result.push_back({"single-point, " + name + ", Kozeny-Carman",
                      model::make_case(model::column_mesh(4, 4), scene)});

    scene = model::double_point_scene(0.012, 5e-3);
    scene.time.scheme = scheme;
    scene.time.end = 30.0;
    LayerSettings layers;
    layers.inflow = layers.outflow = layers.above = layers.below = 1;
    result.push_back({"double-point, " + name,
                      model::make_double_point_case(model::layered_mesh(4, layers), scene)});
  }
  return result;
}

/// The actual cost of a run with output.
struct Actual {
  double steps;
  double memory;
  double disk;
  long snapshots;
};
Actual run(const Case<2>& c) {
  const TemporaryFolder folder;
  const std::string results = folder.file("run.results");
  const SolverOptions options;
  EXPECT_EQ(run_case(c, make_plan(c, options), options, results, {.quiet = true}), 0);
  const auto info = nlohmann::json::parse(test::read_file(results + "/run.json"));
  Actual actual{info["steps"], info["memory_bytes"], 0.0, 0};
  for (const auto& entry : fs::recursive_directory_iterator(results)) {
    if (!entry.is_regular_file()) continue;
    actual.disk += static_cast<double>(entry.file_size());
    if (entry.path().filename().string().starts_with("mesh_0")) ++actual.snapshots;
  }
  return actual;
}

void expect_within_factor(double factor, double estimate, double actual) {
  EXPECT_LE(estimate, factor * actual);
  EXPECT_GE(estimate, actual / factor);
}

TEST(OutputTimes, CountsThemselves) {
  for (const auto& [every, end] : std::vector<std::pair<double, double>>{
           {1.0, 120.0}, {0.1, 0.3}, {0.7, 10.0}, {5.0, 3.0}, {1e-3, 1.0}}) {
    OutputTimes times(every, end);
    long count = 0;
    for (; !times.finished(); times.advance()) ++count;
    EXPECT_EQ(OutputTimes(every, end).count(), count) << every << " to " << end;
    EXPECT_EQ(times.past(), count);
  }
}

TEST(OutputSchedule, MergesRowsAndSnapshots) {
  Scene scene;
  scene.time.end = 1.0;
  scene.output.every = 0.25;
  scene.output.snapshot_every = 0.5;
  OutputSchedule schedule(scene);
  std::string outputs;
  while (!schedule.finished()) {
    const double time = schedule.next();
    EXPECT_FALSE(schedule.take(time - 0.125).row) << "nothing is due between outputs";
    const OutputSchedule::Due due = schedule.take(time);
    outputs +=
        short_text(time) + (due.row ? " row" : "") + (due.snapshot ? " snapshot" : "") + ", ";
  }
  EXPECT_EQ(outputs, "0 row snapshot, 0.25 row, 0.5 row snapshot, 0.75 row, 1 row snapshot, ");
}

TEST(OutputSchedule, ComesMoreOftenWhileSoilFails) {
  Scene scene;
  scene.time.end = 1.0;
  scene.output.every = 0.25;
  scene.output.snapshot_every = 0.5;
  scene.output.failure_every = 0.1;
  OutputSchedule schedule(scene);
  std::string outputs;
  double time = 0.0;
  while (!schedule.finished()) {
    schedule.follow_failure(time, time > 0.3 && time < 0.65, 0.07);
    time = std::min(schedule.next(), time + 0.07);
    const OutputSchedule::Due due = schedule.take(time);
    if (!due.row) continue;
    outputs += short_text(time) + (due.snapshot ? " snapshot, " : ", ");
  }
  EXPECT_EQ(outputs,
            "0 snapshot, 0.25, 0.4 snapshot, 0.5 snapshot, 0.6 snapshot, 0.75, 1 snapshot, ");
  EXPECT_EQ(schedule.past_rows().count, 7);
  EXPECT_EQ(schedule.past_snapshots().count, 5);
  EXPECT_EQ(schedule.past_rows().last, 1.0);
}

/// Outputs every 1e-12 s would stop the progress of a failing run: 1e-12 s later is the same time
/// up to round-off.
TEST(OutputSchedule, ShortensNoStepToLessThanItsOwnLength) {
  Scene scene;
  scene.time.end = 1.0;
  scene.output.every = scene.output.snapshot_every = 0.5;
  scene.output.failure_every = 1e-12;
  OutputSchedule schedule(scene);
  std::string outputs;
  double time = 0.0;
  while (!schedule.finished()) {
    schedule.follow_failure(time, time > 0.3 && time < 0.65, 0.1);
    time = std::min(schedule.next(), time + 0.1);
    const OutputSchedule::Due due = schedule.take(time);
    if (due.row) outputs += short_text(time) + (due.snapshot ? " snapshot, " : ", ");
  }
  EXPECT_EQ(outputs,
            "0 snapshot, 0.4 snapshot, 0.5 snapshot, 0.6 snapshot, 0.7 snapshot, 1 snapshot, ");
}

TEST(OutputSchedule, TimesThatDifferByRoundOffAreOne) {
  Scene scene;
  scene.time.end = 3.0 * 0.1;  // more than 0.3
  scene.output.every = 0.1;
  scene.output.snapshot_every = 0.3;
  OutputSchedule schedule(scene);
  int count = 0;
  for (; !schedule.finished(); ++count) {
    const OutputSchedule::Due due = schedule.take(schedule.next());
    EXPECT_EQ(due.snapshot, count == 0 || count == 3);
    EXPECT_TRUE(due.row);
  }
  EXPECT_EQ(count, 4);
}

TEST(Estimate, OfAWholeTrialIsTheRun) {
  for (const auto& [name, input] : examples()) {
    SCOPED_TRACE(name);
    const Estimate estimate = estimate_run(input, make_plan(input, {}), {.seconds = 60.0});
    const Actual actual = run(input);
    EXPECT_TRUE(estimate.whole);
    EXPECT_EQ(estimate.steps, actual.steps);
    EXPECT_EQ(estimate.snapshots, actual.snapshots);
    expect_within_factor(1.05, estimate.disk, actual.disk);
    expect_within_factor(2.0, estimate.memory, actual.memory);
  }
}

TEST(Estimate, OfAQuarterIsNear) {
  for (const auto& [name, input] : examples()) {
    SCOPED_TRACE(name);
    const TrialBudget quarter{.seconds = 60.0, .share = 0.25};
    const Estimate estimate = estimate_run(input, make_plan(input, {}), quarter);
    const Actual actual = run(input);
    EXPECT_FALSE(estimate.whole);
    EXPECT_LT(static_cast<double>(estimate.trial_steps), actual.steps);
    expect_within_factor(2.0, estimate.steps, actual.steps);
    expect_within_factor(1.5, estimate.disk, actual.disk);
  }
}

TEST(Estimate, OfTheStartUpAloneIsNear) {
  for (const auto& [name, input] : examples()) {
    if (input.document.scene.time.scheme != FlowScheme::implicit_mixed) continue;
    if (input.document.scene.initial_flow == InitialFlow::steady) continue;
    SCOPED_TRACE(name);
    // The trial covers less than a hundredth of the time in which the flow settles.
    const TrialBudget start{.seconds = 60.0, .share = 1e-4};
    const Estimate estimate = estimate_run(input, make_plan(input, {}), start);
    EXPECT_GT(estimate.pilot_steps, 0);
    EXPECT_LT(estimate.trial_time, 0.01);
    expect_within_factor(2.0, estimate.steps, run(input).steps);
  }
}

/// A scene of the workflows or the cases, on a coarse mesh.
Case<2> case_of(const TemporaryFolder& folder, const std::string& scene, const std::string& size) {
  const std::string path = folder.file("scene.case.h5");
  const std::string command = test::program_folder() + "/suffuse-mesher " + test::source_folder() +
                              "/" + scene + " -o " + path + " --set mesh.size=" + size +
                              " > /dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return read_case<2>(path);
}

/// A trial of a tenth of the time does not reach the end of erosion or most breakpoints.
TEST(Estimate, LooksAheadInScenesOfManyKinds) {
  const std::vector<std::pair<std::string, std::string>> scenes{
      {"workflows/examples/weir/weir.toml", "0.25"},     // erosion below a weir
      {"workflows/examples/levee/flood.toml", "1.5"},    // breakpoints, seepage faces, retention
      {"workflows/laboratory/channel.toml", "25e-3"},    // a drive that grows with the pores
      {"workflows/examples/decades/weir.toml", "0.25"},  // a hundred years from rest
      {"workflows/stress/kill-bank.toml", "0.5"},        // soil that moves
  };
  for (const auto& [scene, size] : scenes) {
    SCOPED_TRACE(scene);
    const TemporaryFolder folder;
    const Case<2> input = case_of(folder, scene, size);
    const TrialBudget tenth{.seconds = 60.0, .share = 0.1, .ahead = 60.0, .patience = 120.0};
    const Estimate estimate = estimate_run(input, make_plan(input, {}), tenth);
    EXPECT_FALSE(estimate.too_short);
    EXPECT_GT(estimate.pilot_steps, 0);
    expect_within_factor(2.0, estimate.steps, run(input).steps);
  }
}

TEST(Estimate, SaysThatNoStepEndedInTime) {
  const Case<2> c =
      model::make_case(model::column_mesh(4, 4), single_point_scene(FlowScheme::implicit_mixed));
  const auto said = sentences(estimate_run(c, make_plan(c, {}), {.patience = 1e-9}), 1);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].find("estimate: none, as no step ended within "), 0U) << said[0];
}

TEST(Estimate, SaysWhatItRestsOn) {
  const Case<2> c =
      model::make_case(model::column_mesh(4, 4), single_point_scene(FlowScheme::explicit_nodal));
  const Plan plan = make_plan(c, {});
  const std::vector<std::string> whole = sentences(estimate_run(c, plan, {.seconds = 60.0}), 1);
  ASSERT_EQ(whole.size(), 2U);
  EXPECT_NE(whole[0].find(" on 1 thread, "), std::string::npos) << whole[0];
  EXPECT_NE(whole[0].find(" MB of memory, "), std::string::npos) << whole[0];
  EXPECT_NE(whole[0].find(" in 41 snapshots and its tables"), std::string::npos) << whole[0];
  EXPECT_EQ(whole[1], "estimate: from a trial of the whole run without writing");

  const std::vector<std::string> one = sentences(estimate_run(c, plan, {.seconds = 0.0}), 2);
  EXPECT_NE(one[0].find(" on 2 threads, "), std::string::npos) << one[0];
  EXPECT_NE(one[1].find("a trial of the first 2 steps (t = "), std::string::npos) << one[1];
  EXPECT_NE(one[1].find("too large for a longer one"), std::string::npos) << one[1];
}

TEST(Estimate, SaysWhatTheOtherTransportWouldCost) {
  for (const auto transport : {TransportScheme::explicit_steps, TransportScheme::implicit_sweeps}) {
    Scene scene = single_point_scene(FlowScheme::implicit_mixed);
    scene.time.transport = transport;
    const Case<2> c = model::make_case(model::column_mesh(4, 4), scene);
    const auto said = sentences(estimate_run(c, make_plan(c, {}), {.seconds = 60.0}), 1);
    ASSERT_EQ(said.size(), 3U);
    const bool is_explicit = transport == TransportScheme::explicit_steps;
    EXPECT_EQ(said[2].find(is_explicit ? "transport: explicit, " : "transport: implicit, "), 0U)
        << said[2];
    EXPECT_NE(
        said[2].find(is_explicit ? "; implicit would take at least " : "; explicit would take "),
        std::string::npos)
        << said[2];
  }
}

TEST(Estimate, SaysThatARunFails) {
  Scene scene = single_point_scene(FlowScheme::explicit_nodal);
  scene.boundaries[0].pressure = 1e9;
  const Case<2> c = model::make_case(model::column_mesh(4, 4), scene);
  const Estimate estimate = estimate_run(c, make_plan(c, {}), {.seconds = 60.0});
  EXPECT_NE(estimate.failure, "");
  EXPECT_EQ(sentences(estimate, 1).back(), "the run will fail: " + estimate.failure);
}

TEST(Explain, PrintsTheEstimateAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "here");
  fs::create_directory(folder.path() / "temporary");
  const std::string mesher = test::program_folder() + "/suffuse-mesher " + test::source_folder() +
                             "/workflows/paper/sp-constant-figure.toml -o " +
                             folder.file("run.case.h5") + " > /dev/null 2>&1";
  ASSERT_EQ(std::system(mesher.c_str()), 0);
  const auto explain = [&](const std::string& temporary) {
    const std::string command = "cd " + folder.file("here") + " && TMPDIR=" + temporary + " " +
                                test::program_folder() + "/suffuse-solver " +
                                folder.file("run.case.h5") + " --explain > " + folder.file("out") +
                                " 2> " + folder.file("error");
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 0) << test::read_file(folder.file("error"));
    return test::read_file(folder.file("out"));
  };
  const std::string text = explain(folder.file("temporary"));
  EXPECT_NE(text.find("\nestimate: "), std::string::npos) << text;
  EXPECT_NE(text.find("from a trial of the whole run"), std::string::npos) << text;
  EXPECT_TRUE(fs::is_empty(folder.path() / "here"));
  EXPECT_TRUE(fs::is_empty(folder.path() / "temporary"));
  EXPECT_EQ(folder.count(), 5);  // the files here, temporary, run.case.h5, out, error

  EXPECT_NE(explain(folder.file("missing")).find("of unknown size"), std::string::npos);
}

}  // namespace estimate_test
TEST(RankTrial, IsReadFromItsLine) {
  const RankTrial trial{.ranks = 4, .steps = 17, .seconds = 0.125, .memory = 3e9, .largest = 1e9};
  const RankTrial read = rank_trial_of("run: flow\n" + sentence(trial) + "\n");
  EXPECT_EQ(read.ranks, 4);
  EXPECT_EQ(read.steps, 17);
  EXPECT_DOUBLE_EQ(read.seconds, 0.125);
  EXPECT_DOUBLE_EQ(read.memory, 3e9);
  EXPECT_DOUBLE_EQ(read.largest, 1e9);
  EXPECT_EQ(rank_trial_of(sentence({.ranks = 1, .steps = 1})).steps, 1);
  EXPECT_THROW(rank_trial_of("nothing"), NumericalError);
}

TEST(RankTrial, RecommendsTheFewestThatAreNearlyAsFastAsAny) {
  const auto trial = [](int ranks, double seconds) {
    return RankTrial{.ranks = ranks, .steps = 5, .seconds = seconds};
  };
  EXPECT_EQ(recommended({trial(1, 1.0), trial(2, 0.55), trial(4, 0.52)}).ranks, 2);
  EXPECT_EQ(recommended({trial(1, 1.0), trial(2, 0.95), trial(4, 1.5)}).ranks, 1);
  EXPECT_EQ(recommended({trial(1, 1.0), trial(2, 0.5), trial(4, 0.25)}).ranks, 4);
}

}  // namespace suffuse
