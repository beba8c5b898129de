/// Runs in stages: a finished run is resumed to a later end, or its last state starts another run.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "files/layout.hpp"
#include "results/reader.hpp"
#include "solver/solver_process.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace stages_test {

namespace fs = std::filesystem;
using test::Outcome;
using test::Process;

void expect_balanced(const Table& ledger) {
  for (const char* column : {"residual_water", "residual_grains"}) {
    for (const double residual : ledger.column(column)) EXPECT_LE(std::abs(residual), 1e-12);
  }
}

/// A mode whose steps and warnings do not depend on the end of the run.
test::Mode with_given_step(std::size_t index) {
  const test::Mode mode = test::five_modes()[index];
  const std::string slow =
      R"(time={end = 5.0, scheme = "explicit", mass_scaling = 3.0, step = 4e-4})";
  switch (index) {
    case 0:
      return mode;
    case 1:
      return test::with(mode, "implicit_step", {"time.step=0.05", "time.transport=explicit"});
    case 3:
      return test::with(mode, "implicit_points_step", {"time.step=0.05"});
    default:
      return test::with(mode, mode.name, {slow});
  }
}

double end_of(const test::Mode& mode) {
  return mode.name == "single_point_explicit" ? 0.5 : 5.0;
}

class StagesBase : public testing::Test {
 protected:
  /// The case of a mode that ends at `end`, made under the same name.
  [[nodiscard]] std::string case_until(const test::Mode& mode, double end) const {
    return place_.make_case(test::with(mode, mode.name, {"time.end=" + std::to_string(end)}));
  }
  void solve(const std::string& case_path, const std::string& folder,
             const std::vector<std::string>& options = {}) const {
    const Outcome outcome = place_.solve(case_path, folder, options);
    ASSERT_EQ(outcome.code, 0) << outcome.error;
  }
  void expect_refused(const std::string& case_path, const std::string& folder,
                      const std::vector<std::string>& options, const std::string& message) const {
    const bool exists = fs::exists(folder);
    const std::string before = exists ? test::contents(folder) : "";
    const Outcome outcome = place_.solve(case_path, folder, options);
    EXPECT_EQ(outcome.code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
    EXPECT_EQ(fs::exists(folder), exists);
    if (exists) {
      EXPECT_TRUE(before == test::contents(folder)) << "something was touched";
    }
  }

  test::Workplace place_;
};

class Stages : public StagesBase, public testing::WithParamInterface<std::size_t> {};

// --- To a later end ------------------------------------------------------------------------------

TEST_P(Stages, TwoAreOneRunToTheLastBit) {
  const test::Mode mode = with_given_step(GetParam());
  const double end = end_of(mode);
  const std::string whole = place_.path("whole");
  const std::string staged = place_.path("staged");
  solve(case_until(mode, 0.5 * end), staged);
  const std::string longer = case_until(mode, end);
  solve(longer, whole);
  EXPECT_NE(test::difference(staged, whole), "");
  solve(longer, staged, {"--resume", "--threads", "2"});
  EXPECT_EQ(test::difference(staged, whole), "");
  // The run in the folder is finished now.
  const std::string before = test::contents(staged);
  solve(longer, staged, {"--resume"});
  EXPECT_TRUE(before == test::contents(staged));
}

std::string name_of(const testing::TestParamInfo<std::size_t>& info) {
  return test::five_modes()[info.param].name;
}
INSTANTIATE_TEST_SUITE_P(Modes, Stages, testing::Values(0, 1, 2, 3, 4), name_of);

/// With one mode only: the others use the same code.
class Stage : public StagesBase {
 protected:
  [[nodiscard]] static test::Mode mode() { return test::five_modes()[1]; }
};

TEST_F(Stage, StepsByToleranceAgreeWithinIt) {
  const std::string whole = place_.path("whole");
  const std::string staged = place_.path("staged");
  solve(case_until(mode(), 2.5), staged);
  const std::string longer = case_until(mode(), 5.0);
  solve(longer, whole);
  solve(longer, staged, {"--resume"});
  const Table a = ResultsReader(whole).ledger();
  const Table b = ResultsReader(staged).ledger();
  ASSERT_EQ(a.column("t"), b.column("t"));
  for (const char* column : {"eroded", "water_out", "fines_out"}) {
    EXPECT_NEAR(b.column(column).back(), a.column(column).back(), 1e-3 * a.column(column).back());
  }
  expect_balanced(b);
  EXPECT_EQ(test::flaws(staged), "");
}

TEST_F(Stage, TheFirstMayEndBetweenOutputs) {
  const std::string folder = place_.path("staged");
  solve(case_until(mode(), 1.234), folder);
  solve(case_until(mode(), 2.05), folder, {"--resume"});
  const std::vector<double> times = ResultsReader(folder).history().column("t");
  // There are multiples of 0.1 s, and both ends.
  ASSERT_EQ(times.size(), 23U);
  EXPECT_NEAR(times[12], 1.2, 1e-12);
  EXPECT_NEAR(times[13], 1.234, 1e-12);
  EXPECT_NEAR(times[14], 1.3, 1e-12);
  EXPECT_NEAR(times[22], 2.05, 1e-12);
  EXPECT_EQ(ResultsReader(folder).times(),
            (std::vector<double>{0.0, 0.5, 1.0, 1.234, 1.5, 2.0, 2.05}));
  EXPECT_EQ(test::flaws(folder), "");
  const std::string case_copy = folder + "/" + layout::case_copy;
  EXPECT_EQ(test::read_file(case_copy), test::read_file(case_until(mode(), 2.05)));
}

/// Three times 0.1 is more than 0.3 in the last digit, and is still one output.
TEST_F(Stage, AnEndThatIsAnOutputTimeIsOneOutput) {
  const std::string folder = place_.path("staged");
  solve(case_until(mode(), 0.3), folder);
  solve(case_until(mode(), 0.6), folder, {"--resume"});
  const std::vector<double> times = ResultsReader(folder).history().column("t");
  ASSERT_EQ(times.size(), 7U);
  for (int k = 0; k < 7; ++k) EXPECT_NEAR(times[k], 0.1 * k, 1e-12);
}

/// Inertia that a longer run does not notice is skipped: the user is told if the first stage had
/// it.
TEST_F(Stage, ALaterEndThatTurnsOffInertiaIsSaid) {
  const std::string folder = place_.path("staged");
  solve(case_until(mode(), 1.0), folder);
  const Outcome as_before = place_.solve(case_until(mode(), 1.1), folder, {"--resume"});
  EXPECT_EQ(as_before.code, 0);
  EXPECT_EQ(as_before.error.find("time.inertia"), std::string::npos) << as_before.error;
  const Outcome longer = place_.solve(case_until(mode(), 20.0), folder, {"--resume"});
  EXPECT_EQ(longer.code, 0);
  EXPECT_NE(longer.error.find("time.inertia is false with this time.end, and was true with "
                              "time.end = 1.1 s"),
            std::string::npos)
      << longer.error;
}

TEST_F(Stage, TheSecondCanBeStoppedAndGoesOn) {
  const test::Mode given = with_given_step(1);
  const std::string whole = place_.path("whole");
  const std::string staged = place_.path("staged");
  solve(case_until(given, 2.5), staged);
  const std::string longer = case_until(given, 5.0);
  solve(longer, whole);
  solve(longer, staged, {"--resume"});
  for (const int index : {4, 5, 7}) {
    const std::string stopped = place_.copy(staged, "stopped");
    test::stop_after_snapshot(stopped, index);
    solve(longer, stopped, {"--resume"});
    EXPECT_EQ(test::difference(stopped, whole), "") << index;
  }
}

TEST_F(Stage, NothingElseMayDiffer) {
  const std::string folder = place_.path("staged");
  solve(case_until(mode(), 1.0), folder);
  const auto changed = [&](const std::vector<std::string>& sets) {
    std::vector<std::string> all{"time.end=2.0"};
    all.insert(all.end(), sets.begin(), sets.end());
    return place_.make_case(test::with(mode(), mode().name, all));
  };
  expect_refused(
      changed({"soil.specimen.erosion.rate=5.0", "liquid.viscosity=2e-3"}), folder, {"--resume"},
      folder +
          ": cannot be resumed: it holds the results of another case; choose "
          "another folder with -o, take the case it began with, in which nothing but "
          "time.end, output.restarts and output.precision may be changed, or replace them "
          "with --force in the place of --resume. What differs:\n"
          "  liquid.viscosity: 0.001 there, 0.002 here\n"
          "  soil.specimen.erosion.rate: 4 there, 5 here\n");
  expect_refused(changed({"output.every=0.05"}), folder, {"--resume"},
                 "What differs:\n  output.every: 0.1 there, 0.05 here\n");
  expect_refused(changed({"mesh.size=0.25"}), folder, {"--resume"},
                 "What differs:\n  mesh.size: 0.125 there, 0.25 here\n  the mesh or the points\n");
  expect_refused(
      case_until(mode(), 0.75), folder, {"--resume"},
      "time.end: got 0.75; expected no less than 1 s, which the run in " + folder + " has reached");
  solve(changed({"output.restarts=1", "output.precision=float32"}), folder, {"--resume"});
  EXPECT_EQ(test::flaws(folder), "");
}

// --- Another scene from its last state -----------------------------------------------------------

class FromEarlierBase : public StagesBase {
 protected:
  /// A scene that starts from `a.results`, which contains its first half.
  [[nodiscard]] test::Mode second(const test::Mode& first,
                                  const std::vector<std::string>& sets = {}) const {
    std::vector<std::string> all{"name=second", "initial.from=a.results",
                                 "time.end=" + std::to_string(0.5 * end_of(first))};
    all.insert(all.end(), sets.begin(), sets.end());
    return test::with(first, "second", all);
  }
  void run_first(const test::Mode& mode) const {
    solve(case_until(mode, 0.5 * end_of(mode)), place_.path("a.results"));
  }
};

class FromEarlier : public FromEarlierBase, public testing::WithParamInterface<std::size_t> {};

TEST_P(FromEarlier, TheLedgerStartsWithTheMassesOfTheEarlierRun) {
  const test::Mode mode = test::five_modes()[GetParam()];
  run_first(mode);
  const std::string folder = place_.path("b.results");
  solve(place_.make_case(second(mode)), folder);
  const Table earlier = ResultsReader(place_.path("a.results")).ledger();
  const Table ledger = ResultsReader(folder).ledger();
  EXPECT_EQ(ledger.column("t").front(), 0.0);
  EXPECT_GT(earlier.column("eroded").back(), 0.0);
  for (const char* column : {"solid", "erodible", "water", "fines", "pending", "points"}) {
    const double mass = earlier.column(column).back();
    EXPECT_NEAR(ledger.column(column).front(), mass, 1e-14 * mass) << column;
  }
  for (const char* column : {"eroded", "deposited", "water_in", "fines_out"}) {
    EXPECT_EQ(ledger.column(column).front(), 0.0) << column;
  }
  EXPECT_GT(ledger.column("eroded").back(), 0.0);
  expect_balanced(ledger);
  const auto info = nlohmann::json::parse(test::read_file(folder + "/run.json"));
  EXPECT_TRUE(info.at("plan").front().get<std::string>().starts_with("run: from the state of "));
}

TEST_P(FromEarlier, GoesOnAsTheEarlierRunWouldHave) {
  // Only the start of erosion depends on the time in this scene, and it is past.
  test::Mode mode = test::five_modes()[GetParam()];
  run_first(mode);
  const std::string folder = place_.path("b.results");
  std::vector<std::string> sets;
  if (mode.name.starts_with("double")) sets.emplace_back("soil.specimen.erosion.start=0.0");
  solve(place_.make_case(second(mode, sets)), folder);
  const std::string whole = place_.path("whole");
  solve(case_until(mode, end_of(mode)), whole);
  const Table a = ResultsReader(whole).ledger();
  const Table b = ResultsReader(folder).ledger();
  for (const char* column : {"solid", "erodible", "water"}) {
    const double all = a.column(column).front() - a.column(column).back();
    EXPECT_NEAR(b.column(column).back(), a.column(column).back(),
                1e-3 * a.column(column).back() + 2e-2 * std::abs(all))
        << column;
  }
  EXPECT_NEAR(b.column("fines").back(), a.column("fines").back(), 0.1 * a.column("fines").back());
}

TEST_P(FromEarlier, GoesOnAfterAStopWithoutTheEarlierRun) {
  const test::Mode mode = test::five_modes()[GetParam()];
  run_first(mode);
  const std::string case_path = place_.make_case(second(mode));
  const std::string whole = place_.path("b.results");
  solve(case_path, whole);
  fs::remove_all(place_.path("a.results"));
  const std::string stopped = place_.copy(whole, "stopped");
  test::stop_after_snapshot(stopped, test::snapshots_in(whole) / 2);
  solve(case_path, stopped, {"--resume"});
  EXPECT_EQ(test::difference(stopped, whole), "");
}
INSTANTIATE_TEST_SUITE_P(Modes, FromEarlier, testing::Values(0, 1, 2, 3, 4), name_of);

class FromEarlierOnce : public FromEarlierBase {
 protected:
  [[nodiscard]] static test::Mode mode() { return test::five_modes()[1]; }
};

TEST_F(FromEarlierOnce, BoundariesLawsGravityAndSchemeMayDiffer) {
  run_first(mode());
  const std::string case_path = place_.make_case(second(
      mode(),
      {R"(time={end = 0.2, scheme = "explicit"})", "gravity=[0.0, -9.81]",
       "soil.specimen.erosion={law = \"first-order\", rate = 0.1}",
       "soil.specimen.conductivity_law=constant", "soil.specimen.deposition={coefficient = 5.0}",
       "output.every=0.01", "output.snapshot_every=0.1", "boundary[0].pressure=2e3"}));
  const std::string folder = place_.path("b.results");
  solve(case_path, folder);
  expect_balanced(ResultsReader(folder).ledger());
  Process process({test::program_folder() + "/suffuse-solver", case_path, "--explain"},
                  place_.path("explain"));
  const Outcome explained = process.wait();
  EXPECT_EQ(explained.code, 0);
  for (const char* said :
       {"run: from the state of ", "differs: boundary[0].pressure: 6000 there, 2000 here",
        "differs: gravity: nothing there, [0.0, -9.81] here"}) {
    EXPECT_NE(explained.error.find(said), std::string::npos) << explained.error;
  }
  // Starts the first scene again from there, with the deposits.
  solve(place_.make_case(test::with(mode(), "third", {"name=third", "initial.from=b.results"})),
        place_.path("c.results"));
  const Table ledger = ResultsReader(place_.path("c.results")).ledger();
  expect_balanced(ledger);
  EXPECT_EQ(ledger.column("deposited").front(), 0.0);
}

TEST_F(FromEarlierOnce, PointsThatCarryTheFlowMayStopToAndStart) {
  const test::Mode along = test::five_modes()[2];
  run_first(along);
  solve(place_.make_case(second(along, {"flow.integration=material-point"})),
        place_.path("b.results"));
  expect_balanced(ResultsReader(place_.path("b.results")).ledger());
  solve(place_.make_case(test::with(test::five_modes()[3], "third",
                                    {"name=third", "initial.from=b.results", "time.end=1.0"})),
        place_.path("c.results"));
  expect_balanced(ResultsReader(place_.path("c.results")).ledger());
}

/// A filter without fines of its own catches some, and a stage without deposition washes them out
/// at the rate lambda |q|: exp(-10 1/m * 1e-4 m/s * 2000 s) of them stay.
TEST_F(FromEarlierOnce, DepositsOfAnEarlierRunErode) {
  const std::string filter = R"(
formulation = "single-point"
gravity = [0.0, 0.0]
geometry = {shape = "column", width = 0.1, height = 1.0}
mesh.size = 0.1
liquid = {density = 1000.0, bulk_modulus = inf, viscosity = 1e-3}
output.every = 500.0
)";
  const auto scene = [&](const std::string& concentration, const std::string& end,
                         const std::string& law) {
    return filter + "time.end = " + end +
           "\nboundary = [{on = \"bottom\", pressure = 0.0}, {on = \"top\", darcy_flux = 1e-4, "
           "concentration = " +
           concentration +
           "}]\n[soil.specimen]\nporosity = 0.4\nskeleton_fraction = 0.6\n"
           "grain_density = 2650.0\nconductivity = 1e-3\n" +
           law;
  };
  solve(place_.make_case({"filled",
                          scene("0.02", "1000.0", "deposition.coefficient = 2.0\n"),
                          {"initial.flow=steady"}}),
        place_.path("a.results"));
  solve(place_.make_case({"washed",
                          scene("0.0", "2000.0", "erosion = {law = \"flux\", rate = 10.0}\n"),
                          {"initial.from=a.results"}}),
        place_.path("b.results"));
  const Table ledger = ResultsReader(place_.path("b.results")).ledger();
  const double deposits = ledger.column("erodible").front();
  EXPECT_GT(deposits, 0.1);
  EXPECT_NEAR(ledger.column("erodible").back(), deposits * std::exp(-2.0), 1e-3 * deposits);
  expect_balanced(ledger);
}

TEST_F(FromEarlierOnce, UnsaturatedSoilKeepsItsWater) {
  const test::Mode drained =
      test::with(mode(), "single_point_implicit",
                 {"gravity=[0.0, -9.81]",
                  "soil.specimen.retention={model = \"van-genuchten\", alpha = 3.0, n = 2.0}",
                  R"(boundary=[{on = "right", head = [[0.0, 0.9], [2.0, 0.3]]}])"});
  run_first(drained);
  const std::string folder = place_.path("b.results");
  solve(place_.make_case(second(drained, {R"(boundary=[{on = "right", head = 0.3}])"})), folder);
  const Table earlier = ResultsReader(place_.path("a.results")).ledger();
  const Table ledger = ResultsReader(folder).ledger();
  const double water = earlier.column("water").back();
  EXPECT_LT(water, 0.95 * earlier.column("water").front()) << "air is in the pores";
  EXPECT_NEAR(ledger.column("water").front(), water, 1e-14 * water);
  expect_balanced(ledger);
}

struct MovedPoints {
  std::vector<int> id;
  std::vector<double> upwards;  ///< m
};

/// Displacements at the end of a run.
MovedPoints moved_points(const std::string& folder) {
  const ResultsReader results(folder);
  const std::size_t last = results.times().size() - 1;
  const Field displacement = results.field(last, "solid", "displacement");
  MovedPoints points;
  for (const double id : results.field(last, "solid", "id").values) {
    points.upwards.push_back(displacement.values[2 * points.id.size() + 1]);
    points.id.push_back(static_cast<int>(id));
  }
  return points;
}

class FromMovedSoil : public FromEarlierOnce {};

TEST_F(FromMovedSoil, GoesOnFromItsStressAndItsPlace) {
  // The load is constant in the second half.
  const test::Mode moving = test::moving_mode();
  run_first(moving);
  const std::string folder = place_.path("b.results");
  solve(place_.make_case(second(moving, {"boundary[0].traction=[0.0, -3e4]"})), folder);
  const std::string whole = place_.path("whole");
  solve(case_until(moving, 5.0), whole);
  // The second run numbers the points anew, in the order of the last snapshot of the first.
  const MovedPoints before = moved_points(place_.path("a.results"));
  const MovedPoints after = moved_points(folder);
  const MovedPoints all_along = moved_points(whole);
  double largest = 0.0;
  double error = 0.0;
  for (std::size_t i = 0; i < after.id.size(); ++i) {
    const std::size_t j = after.id[i];
    const auto found = std::ranges::find(all_along.id, before.id[j]);
    const double in_whole = all_along.upwards[found - all_along.id.begin()];
    largest = std::max(largest, std::abs(after.upwards[i]));
    error = std::max(error, std::abs(before.upwards[j] + after.upwards[i] - in_whole));
  }
  EXPECT_GT(largest, 2e-3);
  EXPECT_LT(error, 0.01 * largest);
  const Table earlier = ResultsReader(place_.path("a.results")).ledger();
  const Table ledger = ResultsReader(folder).ledger();
  for (const char* column : {"solid", "erodible", "water", "fines"}) {
    const double mass = earlier.column(column).back();
    EXPECT_NEAR(ledger.column(column).front(), mass, 1e-12 * mass) << column;
  }
  expect_balanced(ledger);
  const Table all = ResultsReader(whole).ledger();
  EXPECT_NEAR(ledger.column("eroded").back(),
              all.column("eroded").back() - earlier.column("eroded").back(),
              2e-2 * ledger.column("eroded").back());
}

/// A relative path starts at the folder of the scene, wherever the programs run. A folder of the
/// same name in the working folder is not used.
TEST_F(FromEarlierOnce, TheFolderLiesBesideTheScene) {
  run_first(mode());
  const std::string at_home = place_.path("");
  const test::Mode next = second(mode());
  std::ofstream(place_.path("second.toml")) << next.scene;
  std::vector<std::string> words{test::program_folder() + "/suffuse-mesher", "second.toml", "-o",
                                 place_.path("second.case.h5")};
  for (const std::string& set : next.sets) words.insert(words.end(), {"--set", set});
  const Outcome made =
      Process(words, place_.path("mesher.txt"), [&] { fs::current_path(at_home); }).wait();
  ASSERT_EQ(made.code, 0) << made.error;
  const std::string elsewhere = place_.path("elsewhere");
  fs::create_directories(elsewhere + "/a.results");
  const Outcome outcome = place_.solve(place_.path("second.case.h5"), place_.path("b.results"), {},
                                       [&] { fs::current_path(elsewhere); });
  EXPECT_EQ(outcome.code, 0) << outcome.error;
}

TEST_F(FromEarlierOnce, WhatDoesNotFitIsRefused) {
  const auto expect = [&](const std::vector<std::string>& sets, const std::string& message) {
    expect_refused(place_.make_case(second(mode(), sets)), place_.path("b.results"), {}, message);
  };
  const std::string source = place_.path("a.results");
  expect({},
         "initial.from: got \"a.results\", where there are no results; expected a results "
         "folder, relative to that of the scene; looked for in " +
             source);
  run_first(mode());
  expect({"soil.specimen.porosity=0.31", "liquid.density=998.0"},
         "liquid.density: got 998; expected 1000, as in " + source +
             ", from whose state the run starts");
  expect({"soil.specimen.porosity=0.31"}, "soil.specimen.porosity: got 0.31; expected 0.3, as in ");
  expect({"mesh.size=0.25"},
         "initial.from: got \"a.results\", whose mesh or solid points differ; expected a run on "
         "the same mesh and points: the keys of [geometry], [mesh] and points.solid_per_element "
         "as there");
  expect({"soil.specimen.retention={model = \"gardner\", alpha = 3.0}", "gravity=[0.0, -9.81]"},
         "soil.specimen.retention: got another one; expected the same as in ");
  const std::string own = place_.make_case(second(mode(), {"name=single"}));
  expect_refused(own, source, {"--force"},
                 "initial.from: got " + source +
                     ", the folder that this run writes into; "
                     "expected another one: choose it with -o");
  test::stop_after_snapshot(source, 2);
  expect({},
         "initial.from: got \"a.results\", whose run is \"stopped without notice\"; expected a run "
         "that is "
         "done: let it go on with --resume");
}

}  // namespace stages_test
}  // namespace suffuse
