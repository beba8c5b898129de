/// A run that was stopped and resumed gives the same files as an undisturbed one.

#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "common/hdf5_io.hpp"
#include "files/layout.hpp"
#include "results/reader.hpp"
#include "solver/solver_process.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace resume_test {

namespace fs = std::filesystem;
using test::Outcome;
using test::Process;

/// A mode with an undisturbed run of it.
class Resumed : public testing::TestWithParam<test::Mode> {
 protected:
  void SetUp() override { begin(GetParam()); }

  void begin(const test::Mode& mode) {
    case_ = place_.make_case(mode);
    whole_ = place_.path("whole");
    const Outcome outcome = place_.solve(case_, whole_, {"--force"});
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    ASSERT_GE(test::snapshots_in(whole_), 5);
  }

  /// The files after snapshot `index`; rows go on beyond it.
  [[nodiscard]] std::string stopped_after(int index) const {
    std::string folder = place_.copy(whole_, "stopped");
    test::stop_after_snapshot(folder, index);
    return folder;
  }

  void expect_same_when_resumed(const std::string& folder,
                                const std::vector<std::string>& options = {}) const {
    std::vector<std::string> all{"--resume"};
    all.insert(all.end(), options.begin(), options.end());
    const Outcome outcome = place_.solve(case_, folder, all);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_EQ(test::difference(folder, whole_), "");
  }

  /// Sends `signal` to a run after `rows` rows, or as soon as possible later. Returns whether the
  /// run was still going on.
  bool stop_by(int signal, long rows, const std::string& folder,
               const std::vector<std::string>& options = {}) const {
    Process process(test::solver_words(case_, folder, options), place_.path("stopped.txt"));
    const std::string history = folder + "/" + layout::history;
    test::wait_for(process, [&] { return test::lines_in(history) > rows; });
    process.signal(signal);
    const Outcome outcome = process.wait();
    if (outcome.code == 0) return false;
    EXPECT_EQ(outcome.code, 130) << outcome.error;
    EXPECT_NE(outcome.error.find("what is written is complete. To go on:\n  suffuse-solver " +
                                 case_ + " -o " + folder + " --resume\n"),
              std::string::npos)
        << outcome.error;
    EXPECT_TRUE(fs::exists(folder + "/" + layout::checkpoint));
    EXPECT_EQ(test::flaws(folder), "");
    return true;
  }

  /// Stops a run on a machine of any speed: tries earlier and earlier until the signal comes in
  /// time.
  void must_stop_by(int signal, const std::string& folder) const {
    for (long rows = test::lines_in(whole_ + "/" + layout::history) / 2; rows > 0; rows /= 2) {
      fs::remove_all(folder);
      if (stop_by(signal, rows, folder)) return;
    }
    FAIL() << "the run ended each time before it could be interrupted";
  }

  [[nodiscard]] int last() const { return test::snapshots_in(whole_) - 1; }

  test::Workplace place_;
  std::string case_;
  std::string whole_;
};

TEST_P(Resumed, FromTheFirstAMiddleAndTheLastButOneSnapshot) {
  expect_same_when_resumed(stopped_after(0));
  expect_same_when_resumed(stopped_after(last() / 2), {"--threads", "2"});
  expect_same_when_resumed(stopped_after(last() - 1));
}

TEST_P(Resumed, AfterAnInterrupt) {
  const std::string folder = place_.path("interrupted");
  must_stop_by(SIGINT, folder);
  expect_same_when_resumed(folder);
}

std::string name_of(const testing::TestParamInfo<test::Mode>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Modes, Resumed, testing::ValuesIn(test::five_modes()), name_of);

/// Boxes of tetrahedra, where the flow is implicit in both formulations.
std::vector<test::Mode> modes_in_space() {
  const std::vector<test::Mode> modes = test::five_modes();
  const std::string box = R"(geometry={shape = "box", width = 0.5, depth = 0.25, height = 0.5)";
  return {test::with(
              modes[1], "single_point_in_space",
              {box + "}", "mesh.size=0.125", "gravity=[0.0, 0.0, -9.81]", "initial.water_level=1.0",
               "time.transport=implicit", "soil.specimen.porosity_gradient=[0.02, 0.05, 0.1]",
               "output.probe=[{at = [0.2, 0.1, 0.3]}]"}),
          test::with(modes[3], "double_point_in_space",
                     {box + ", layers = {inflow = 1, above = 1, below = 1, outflow = 1}}",
                      R"(mesh={size = 0.15, structure = "free"})", "time.end=3.0",
                      "soil.specimen.deposition={coefficient = 2.0, porosity_min = 0.2}"})};
}

std::vector<test::Mode> variants() {
  const std::vector<test::Mode> modes = test::five_modes();
  const test::Mode& single = modes[1];
  const std::string tables =
      R"(boundary[0]={on = "top", pressure = [[0.0, 0.0], [1.0, 6e3], [3.0, 6e3], [3.00001, 3e3]], )"
      R"(concentration = [[0.0, 0.0], [4.0, 0.1]]})";
  // Fines leave, are caught, and leave again as the flow reverses; the liquid is viscous.
  const std::vector<std::string> soil{
      "soil.specimen.erosion={law = \"autocatalytic\", drive = \"shear-stress\", rate = 0.2, "
      "threshold = 0.5, residual = [[0.0, 0.03], [0.02, 0.01]], critical_concentration = 0.4}",
      "soil.specimen.deposition={coefficient = 5.0, porosity_min = 0.2, flux_max = 0.01}",
      "soil.specimen.conductivity_law=kozeny-carman", "soil.specimen.size_ratio=3.0",
      "liquid.viscosity_law=krieger-dougherty"};
  std::vector<std::string> exchange = soil;
  exchange.emplace_back(
      R"(boundary[0]={on = "top", pressure = [[0.0, 6e3], [2.0, 6e3], [4.0, -6e3]], concentration = 0.1})");
  std::vector<std::string> exchange_with_points = soil;
  exchange_with_points.emplace_back(
      R"(boundary[0]={on = "inflow", darcy_flux = [[0.0, 0.012], [2.0, 0.012], [4.0, 0.004]], concentration = 0.1})");
  std::vector<std::string> implicit = exchange;
  implicit.emplace_back("time.transport=implicit");
  return {
      test::with(single, "implicit_transport", implicit),
      test::with(single, "inertia",
                 {"time.inertia=true", "time.end=1.0",
                  "output={every = 0.02, snapshot_every = 0.1, restarts = 1000}"}),
      test::with(single, "gravity",
                 {"gravity=[0.0, -9.81]", "initial.water_level=1.0", "time.stepping=monotone"}),
      test::with(single, "erosion_length",
                 {"soil.specimen.conductivity_law=kozeny-carman",
                  "soil.specimen.erosion={law = \"first-order\", drive = \"flux\", rate = 20.0, "
                  "threshold = 1e-3, length = 0.2}",
                  "soil.specimen.deposition={coefficient = 2.0, porosity_min = 0.2}"}),
      test::with(single, "ergun", {"soil.specimen.drag=ergun"}),
      // Seepage faces open and close as the head falls and rain falls.
      test::with(
          single, "unsaturated",
          {"gravity=[0.0, -9.81]", "initial.water_level=0.3",
           "soil.specimen.retention={model = \"van-genuchten\", alpha = 3.0, n = 2.0}",
           "soil.specimen.conductivity=[2e-2, 5e-3]", "soil.specimen.bedding=20.0",
           R"(boundary[0]={on = "top", rain = [[0.0, 0.0], [2.0, 3e-2]]})",
           R"(boundary[1]={on = "right", head = [[0.0, 0.3], [2.0, 0.9], [4.0, 0.1], [5.0, 0.6]]})"}),
      test::with(single, "reservoir",
                 {"gravity=[0.0, -9.81]", "initial.water_level=0.3",
                  R"(boundary[0]={on = "top", head = 1.5, reservoir_area = 0.2})"}),
      test::with(single, "boundary_values_in_time", {tables}),
      // The flow is solved once and kept; erosion does not change it.
      test::with(single, "kept_flow",
                 {"soil.specimen.conductivity_law=constant", "liquid.bulk_modulus=inf",
                  "soil.specimen.erosion={law = \"constant\", rate = 2e-2, start = 1.0}"}),
      test::with(single, "leaky_wall",
                 {R"(geometry={file = ")" + test::data_folder() + R"(/geometry/sheet_pile.geo"})",
                  R"(boundary=[{on = "left", pressure = 6e3, concentration = 0.01}, )"
                  R"({on = "right", pressure = 0.0, concentration = 0.0}])",
                  R"(wall=[{on = "pile", conductance = 1e-2}])", "mesh.size=0.4"}),
      test::moving_mode(),
      test::with(modes[0], "explicit_with_implicit_drag", {"time.drag=implicit"}),
      test::with(modes[3], "boundary_values_in_time_with_points",
                 {R"(boundary[0]={on = "inflow", darcy_flux = [[0.0, 0.0], [5.0, 0.02]]})"}),
      test::with(single, "exchange", exchange),
      test::with(modes[3], "exchange_with_points", exchange_with_points),
      test::with(modes[3], "dry_elements_and_random_points",
                 {"points.seeding=random", "points.liquid_per_element=1",
                  "soil.specimen.erosion.empty_elements=dry",
                  "soil.specimen.erosion.mass_transfer=element"}),
  };
}

class ResumedVariant : public Resumed {};

TEST_P(ResumedVariant, FromAMiddleSnapshotAndAfterAnInterrupt) {
  expect_same_when_resumed(stopped_after(last() / 2));
  const std::string folder = place_.path("interrupted");
  must_stop_by(SIGTERM, folder);
  expect_same_when_resumed(folder);
}
INSTANTIATE_TEST_SUITE_P(Modes, ResumedVariant, testing::ValuesIn(variants()), name_of);
INSTANTIATE_TEST_SUITE_P(InSpace, ResumedVariant, testing::ValuesIn(modes_in_space()), name_of);

/// With one mode only: the others use the same code.
class ResumedRun : public Resumed {
 protected:
  /// Steps are shorter than the interval of snapshots, so each snapshot has its state.
  static test::Mode mode() {
    return test::with(test::five_modes()[3], "double_point", {"time.step=0.2"});
  }
  void SetUp() override { begin(mode()); }

  void expect_refused(const std::string& folder, const std::string& case_path,
                      const std::vector<std::string>& options, int code,
                      const std::string& message) const {
    const std::string before = test::contents(folder);
    const Outcome outcome = place_.solve(case_path, folder, options);
    EXPECT_EQ(outcome.code, code) << outcome.error;
    EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
    EXPECT_TRUE(before == test::contents(folder)) << "something was touched";
  }
};

TEST_F(ResumedRun, AcrossSeveralSnapshotsWithinAStep) {
  begin(test::with(
      test::five_modes()[3], "long_steps",
      {"time.step=2.0", "output={every = 0.25, snapshot_every = 0.25, restarts = 1000}"}));
  // Steps end at 2, 4, ... s: only snapshots 8, 16, ... have the state.
  for (const int index : {7, 8, 9}) expect_same_when_resumed(stopped_after(index));
}

TEST_F(ResumedRun, ManyTimesInARow) {
  const std::string folder = place_.path("interrupted");
  const std::string history = folder + "/" + layout::history;
  int stops = 0;
  for (int attempt = 0; attempt < 5; ++attempt) {
    // The run goes on for at least three rows each time.
    const long rows = test::lines_in(history) + 3;
    const std::string threads = attempt % 2 == 0 ? "1" : "2";
    if (stop_by(SIGTERM, rows, folder, {"--resume", "--threads", threads})) ++stops;
  }
  EXPECT_GE(stops, 2);
  expect_same_when_resumed(folder);
}

TEST_F(ResumedRun, AfterALostTerminal) {
  const std::string folder = place_.path("interrupted");
  must_stop_by(SIGHUP, folder);
  expect_same_when_resumed(folder);
}

TEST_F(ResumedRun, CheckpointsByTheClockChangeNothing) {
  const std::string folder = place_.path("kept");
  const Outcome outcome = place_.solve(case_, folder, {"--checkpoint-every", "1e-9"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(test::difference(folder, whole_), "");
  // A killed run resumes from a checkpoint: no snapshot has its time.
  fs::remove_all(folder);
  Process process(test::solver_words(case_, folder, {"--checkpoint-every", "1e-9"}),
                  place_.path("killed.txt"));
  const bool came = test::wait_for(process, [&] {
    return fs::exists(folder + "/" + layout::checkpoint) && test::snapshots_in(folder) > 1;
  });
  process.signal(SIGKILL);
  const int code = process.wait().code;
  if (came && code != 0) {
    EXPECT_TRUE(fs::exists(folder + "/" + layout::checkpoint));
  }
  expect_same_when_resumed(folder, {"--checkpoint-every", "0"});
  const auto info = nlohmann::json::parse(test::read_file(folder + "/run.json"));
  if (came && code != 0) {
    EXPECT_TRUE(info.at("resumed_at").is_number());
  }
}

TEST_F(ResumedRun, AFinishedRunIsLeftAlone) {
  const std::string before = test::contents(whole_);
  const Outcome outcome =
      Process({test::program_folder() + "/suffuse-solver", case_, "-o", whole_, "--resume"},
              place_.path("e"))
          .wait();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.error.substr(0, outcome.error.find('\n')),
            whole_ + " is complete: nothing to resume");
  EXPECT_TRUE(before == test::contents(whole_));
}

TEST_F(ResumedRun, WithoutAnythingThereItBeginsAnew) {
  const std::string missing = place_.path("missing");
  expect_same_when_resumed(missing);
  const std::string empty = place_.path("empty");
  fs::create_directory(empty);
  expect_same_when_resumed(empty);
  // The run was killed before the first snapshot was complete.
  std::string folder = stopped_after(-1);
  for (const char* table : {layout::history, layout::ledger, layout::regions, layout::boundaries}) {
    fs::resize_file(folder + "/" + table, test::read_file(folder + "/" + table).find('\n') + 1);
  }
  for (const char* kind : {"mesh", "solid", "liquid"}) {
    fs::remove(folder + "/" + layout::series(kind));
  }
  std::ofstream(folder + "/snapshots/solid_000000.hdf.tmp") << "half";
  std::ofstream(folder + "/.case.4711.part.h5") << "half";
  expect_same_when_resumed(folder);
  // The run was killed between the first snapshot and its state.
  folder = stopped_after(0);
  fs::remove(layout::in_folder(folder, layout::state(0)));
  for (const char* table : {layout::history, layout::ledger}) {
    const std::string path = layout::in_folder(folder, table);
    const std::string text = test::read_file(path);
    fs::resize_file(path, text.find('\n', text.find('\n') + 1) + 1);
  }
  expect_same_when_resumed(folder);
}

TEST_F(ResumedRun, FromTheCopyOfTheCaseInTheResults) {
  const std::string folder = stopped_after(2);
  fs::remove(case_);
  const Outcome outcome = place_.solve(folder + "/" + layout::case_copy, folder, {"--resume"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(test::difference(folder, whole_), "");
}

TEST_F(ResumedRun, WhatIsLeftOfAKillIsRemoved) {
  const std::string folder = stopped_after(3);
  for (const char* name :
       {"snapshots/mesh_000004.hdf.tmp", "snapshots/solid_000009.hdf", "checkpoint.hdf.tmp",
        "snapshots/state_000009.hdf", "snapshots/state_000004.hdf.tmp",
        "snapshots/mesh_grid.hdf.tmp", "mesh.hdf.series.tmp", "run.json.tmp", ".case.99.part.h5"}) {
    std::ofstream(folder + "/" + name) << "half";
  }
  const std::size_t rows = ResultsReader(folder).history().rows();
  for (const char* table : {layout::history, layout::ledger, layout::regions, layout::boundaries}) {
    std::ofstream(layout::in_folder(folder, table), std::ios::app) << "0.9,0.25";
  }
  EXPECT_EQ(ResultsReader(folder).history().rows(), rows);
  expect_same_when_resumed(folder);
}

/// A mode that keeps the states of only `count` snapshots.
test::Mode with_restarts(const test::Mode& mode, int count) {
  return test::with(
      mode, "few_states",
      {"output={every = 0.1, snapshot_every = 0.5, restarts = " + std::to_string(count) + "}"});
}

TEST_F(ResumedRun, TheNewestSnapshotsKeepTheirState) {
  for (const int count : {1, 2, 3}) {
    SCOPED_TRACE(count);
    begin(with_restarts(mode(), count));
    for (int index = 0; index <= last(); ++index) {
      EXPECT_EQ(fs::exists(layout::in_folder(whole_, layout::state(index))), index > last() - count)
          << index;
    }
    for (int index = last() - count; index < last(); ++index) {
      const std::string folder = stopped_after(index);
      if (index > last() - count) {
        expect_same_when_resumed(folder);
      } else {
        expect_refused(folder, case_, {"--resume"}, 4, "no snapshot there has a state");
      }
    }
  }
}

TEST_F(ResumedRun, AStateGoesOnlyWhenANewerOneIsThere) {
  begin(with_restarts(mode(), 1));
  const std::string folder = place_.path("killed");
  int kills = 0;
  // While a snapshot is written, there are moments without its state.
  for (int index = 1; index < last(); ++index) {
    Process process(test::solver_words(case_, folder, {"--resume"}), place_.path("killed.txt"));
    const std::string begun = layout::in_folder(folder, layout::snapshot("solid", index));
    test::wait_for(process, [&] { return fs::exists(begun); });
    process.signal(SIGKILL);
    if (process.wait().code == 0) break;
    ++kills;
    EXPECT_EQ(test::flaws_after_kill(folder), "");
  }
  EXPECT_GE(kills, 1);
  expect_same_when_resumed(folder);
}

TEST_F(ResumedRun, AMissingOrDamagedGridIsWrittenAgain) {
  const std::string folder = stopped_after(3);
  fs::remove(folder + "/snapshots/mesh_grid.hdf");
  std::ofstream(folder + "/snapshots/solid_grid.hdf") << "text\n";
  expect_same_when_resumed(folder);
}

TEST_F(ResumedRun, FieldsWithSevenDigitsChangeNothingElse) {
  const test::Mode rounded = test::with(
      mode(), "rounded", {"output={every = 0.1, snapshot_every = 0.5, precision = \"float32\"}"});
  const std::string other_case = place_.make_case(rounded);
  const std::string other = place_.path("rounded");
  ASSERT_EQ(place_.solve(other_case, other).code, 0);
  for (const char* table : {layout::history, layout::ledger, layout::regions, layout::boundaries}) {
    EXPECT_EQ(test::read_file(other + "/" + table), test::read_file(whole_ + "/" + table)) << table;
  }
  const ResultsReader exact(whole_);
  const ResultsReader read(other);
  const std::size_t index = exact.times().size() - 1;
  EXPECT_EQ(read.point_positions(index, "liquid"), exact.point_positions(index, "liquid"));
  for (const std::string where : {"cell", "node", "element_vertex", "solid", "liquid"}) {
    for (const std::string& name : exact.field_names(index, where)) {
      const std::vector<double> a = exact.field(index, where, name).values;
      const std::vector<double> b = read.field(index, where, name).values;
      const bool is_whole = name == "id" || name == "element" || name == "region";
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(b[i], is_whole ? a[i] : static_cast<double>(static_cast<float>(a[i]))) << name;
      }
    }
  }
  case_ = other_case;
  whole_ = other;
  expect_same_when_resumed(stopped_after(last() - 1));
}

TEST_F(ResumedRun, AnotherRunIsRefused) {
  const std::string folder = stopped_after(3);
  const std::string another = folder + ": cannot be resumed: it holds the results of another case";
  const std::string set =
      place_.make_case(test::with(mode(), "set", {"soil.specimen.erosion.rate=6e-2"}));
  expect_refused(folder, set, {"--resume"}, 2, another);
  const std::string mesh = place_.make_case(test::with(mode(), "mesh", {"mesh.size=0.0625"}));
  expect_refused(folder, mesh, {"--resume"}, 2, another);
  expect_refused(folder, case_, {"--resume", "--no-skip"}, 2,
                 folder + ": cannot be resumed: it holds the results of a run without --no-skip");
  const std::string scene = place_.make_case(test::with(mode(), "scene", {"name=other"}));
  const std::string other = folder + ": holds results of scene \"double\", not of \"other\"";
  expect_refused(folder, scene, {"--resume"}, 2, other);
  expect_refused(folder, scene, {}, 2, other);
  // Finished runs are refused too.
  expect_refused(whole_, mesh, {"--resume"}, 2,
                 whole_ + ": cannot be resumed: it holds the results of another case");
  expect_same_when_resumed(folder);
}

/// Damage of the newest snapshot, number 5, or of the files that it needs.
struct Damage {
  std::string name;
  std::function<void(const std::string&)> act;
};

void flip_byte(const std::string& path, std::size_t at) {
  std::string bytes = test::read_file(path);
  bytes.at(at) = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(path, std::ios::binary) << bytes;
}

void flip_a_byte_of_the_state(const std::string& folder) {
  const std::string path = folder + "/snapshots/state_000005.hdf";
  std::vector<std::uint8_t> state =
      Hdf5File(path, Hdf5File::Mode::read).read_bytes(layout::restart_state);
  const std::string bytes = test::read_file(path);
  const auto at = bytes.find(std::string(state.begin(), state.end()));
  ASSERT_NE(at, std::string::npos);
  flip_byte(path, at + state.size() / 2);
}

void cut_rows(const std::string& path, long rows) {
  std::istringstream in(test::read_file(path));
  std::string kept;
  std::string line;
  for (long count = 0; count <= rows && std::getline(in, line); ++count) kept += line + "\n";
  std::ofstream(path, std::ios::binary) << kept;
}

const std::vector<Damage>& damages() {
  const auto in_mesh = [](const std::string& folder) {
    return folder + "/snapshots/mesh_000005.hdf";
  };
  static const std::vector<Damage> list{
      {"cut_short",
       [=](const std::string& folder) {
         fs::resize_file(in_mesh(folder), fs::file_size(in_mesh(folder)) - 100);
       }},
      {"empty", [=](const std::string& folder) { fs::resize_file(in_mesh(folder), 0); }},
      {"not_hdf5", [=](const std::string& folder) { std::ofstream(in_mesh(folder)) << "text\n"; }},
      {"of_another_program",
       [=](const std::string& folder) {
         Hdf5File file(in_mesh(folder), Hdf5File::Mode::create);
         file.create_group("/VTKHDF");
       }},
      {"a_bit_of_the_state", flip_a_byte_of_the_state},
      {"state_missing",
       [](const std::string& folder) { fs::remove(folder + "/snapshots/state_000005.hdf"); }},
      {"state_cut_short",
       [](const std::string& folder) {
         fs::resize_file(folder + "/snapshots/state_000005.hdf", 1000);
       }},
      {"solid_cut_short",
       [](const std::string& folder) {
         fs::resize_file(folder + "/snapshots/solid_000005.hdf", 1000);
       }},
      {"liquid_missing",
       [](const std::string& folder) { fs::remove(folder + "/snapshots/liquid_000005.hdf"); }},
      {"liquid_empty",
       [](const std::string& folder) {
         fs::resize_file(folder + "/snapshots/liquid_000005.hdf", 0);
       }},
      {"history_too_short",
       [](const std::string& folder) { cut_rows(folder + "/history.csv", 24); }},
      {"regions_too_short",
       [](const std::string& folder) { cut_rows(folder + "/regions.csv", 24 * 4 + 1); }},
      {"boundaries_too_short",
       [](const std::string& folder) { cut_rows(folder + "/boundaries.csv", 24 * 2 + 1); }},
      {"row_not_ended",
       [](const std::string& folder) {
         const std::string path = folder + "/ledger.csv";
         cut_rows(path, 26);
         fs::resize_file(path, fs::file_size(path) - 1);
       }},
  };
  return list;
}

TEST_F(ResumedRun, FromTheSnapshotBeforeADamagedOne) {
  for (const Damage& damage : damages()) {
    SCOPED_TRACE(damage.name);
    const std::string folder = stopped_after(5);
    damage.act(folder);
    const Outcome outcome = place_.solve(case_, folder, {"--resume"});
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_EQ(test::difference(folder, whole_), "");
    const auto info = nlohmann::json::parse(test::read_file(folder + "/run.json"));
    EXPECT_LT(info.at("resumed_at"), 2.5);
    EXPECT_GE(info.at("resumed_at"), 2.0) << "went further back than it had to";
    // A missing file is no damage: a kill leaves the folder like that.
    if (damage.name.ends_with("missing")) continue;
    EXPECT_NE(outcome.error.find("suffuse-solver: warning: passed over: " + folder),
              std::string::npos)
        << outcome.error;
  }
}

TEST_F(ResumedRun, ADamagedCheckpointIsPassedOver) {
  for (const std::string bytes : {"", "text"}) {
    const std::string folder = stopped_after(5);
    std::ofstream(folder + "/checkpoint.hdf", std::ios::binary) << bytes;
    expect_same_when_resumed(folder);
  }
  const std::string folder = stopped_after(5);
  fs::copy_file(folder + "/snapshots/solid_000003.hdf", folder + "/checkpoint.hdf");
  expect_same_when_resumed(folder);
}

TEST_F(ResumedRun, NothingIsDoneAwayWithWhereNoSnapshotWillDo) {
  const std::string message =
      "cannot be resumed: no snapshot there has a state to go on from; "
      "choose another folder with -o, or run anew without --resume";
  std::string folder = stopped_after(3);
  fs::remove(folder + "/history.csv");
  expect_refused(folder, case_, {"--resume"}, 4, message);
  folder = stopped_after(3);
  fs::resize_file(folder + "/snapshots/mesh_000000.hdf", 1000);
  expect_refused(folder, case_, {"--resume"}, 4, message);
  folder = stopped_after(3);
  fs::remove_all(folder + "/snapshots");
  expect_refused(folder, case_, {"--resume"}, 4, message);
  EXPECT_EQ(place_.solve(case_, folder).code, 0);
  EXPECT_EQ(test::difference(folder, whole_), "");
}

}  // namespace resume_test
}  // namespace suffuse
