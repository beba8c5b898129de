/// Faults around a run: disks, folders, files, signals, streams. Data written before stay readable,
/// the message says what happened, and the run can be resumed to the same end.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <csignal>
#include <memory>
#include <thread>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "files/folder_lock.hpp"
#include "files/layout.hpp"
#include "results/reader.hpp"
#include "solver/own_mounts.hpp"
#include "solver/solver_process.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace faults_test {

namespace fs = std::filesystem;
using test::Outcome;
using test::Process;

const std::string advice =
    "\nWhat was written before is complete. When this is corrected, go on with:\n  suffuse-solver ";

/// A place with an undisturbed run.
class Fault : public testing::Test {
 protected:
  Fault() : case_(place_.make_case(mode())), whole_(place_.path("whole")) {
    const Outcome outcome = place_.solve(case_, whole_);
    if (outcome.code != 0) throw std::runtime_error(outcome.error);
  }

  static test::Mode mode() {
    return test::with(test::five_modes()[3], "double_point", {"time.step=0.2"});
  }

  static std::uintmax_t size_of(const std::string& folder) {
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) bytes += entry.file_size();
    }
    return bytes;
  }

  static void expect_error(const Outcome& outcome, int code, const std::string& message) {
    EXPECT_EQ(outcome.code, code) << outcome.error;
    EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
  }

  void expect_same_when_resumed(const std::string& folder) const {
    const Outcome outcome = place_.solve(case_, folder, {"--resume"});
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_EQ(test::difference(folder, whole_), "");
  }

  /// A run that is stopped (SIGSTOP) in the middle; nothing if it could not be stopped in time.
  [[nodiscard]] std::unique_ptr<Process> paused(
      const std::string& folder, const std::vector<std::string>& options = {},
      const std::function<void()>& prepare = [] {}) const {
    const std::string history = folder + "/" + layout::history;
    for (long rows = test::lines_in(whole_ + "/" + layout::history) / 2; rows > 0; rows /= 2) {
      fs::remove_all(folder);
      auto process = std::make_unique<Process>(test::solver_words(case_, folder, options),
                                               place_.path("paused.txt"), prepare);
      test::wait_for(*process, [&] { return test::lines_in(history) > rows; });
      process->signal(SIGSTOP);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (process->running()) return process;
    }
    throw std::runtime_error("the run ended each time before it could be stopped");
  }

  static Outcome go_on(Process& process) {
    process.signal(SIGCONT);
    return process.wait();
  }

  test::Workplace place_;
  std::string case_;
  std::string whole_;
};

void limit_files_to(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

// --- Disks ---------------------------------------------------------------------------------------

TEST_F(Fault, AFullDiskAtAnyMoment) {
  const std::uintmax_t all = size_of(whole_);
  for (const double share : {0.02, 0.08, 0.2, 0.4, 0.6, 0.8, 0.95}) {
    SCOPED_TRACE(share);
    const test::SmallDisk disk(place_.path("disk"),
                               static_cast<std::uintmax_t>(share * static_cast<double>(all)));
    if (!disk.mounted()) GTEST_SKIP() << "nothing can be mounted here";
    const std::string folder = place_.path("disk/results");
    const Outcome outcome = place_.solve(case_, folder);
    EXPECT_EQ(outcome.code, 4) << outcome.error;
    EXPECT_TRUE(outcome.error.find("No space left on device") != std::string::npos ||
                outcome.error.find("is the disk full?") != std::string::npos)
        << outcome.error;
    if (test::snapshots_in(folder) > 0) {
      expect_error(outcome, 4, advice + case_ + " -o " + folder + " --resume\n");
      EXPECT_EQ(test::flaws(folder), "");
    }
    ASSERT_TRUE(disk.resize(4 * all));
    expect_same_when_resumed(folder);
  }
}

TEST_F(Fault, ADiskFullWhileInterrupting) {
  const test::SmallDisk disk(place_.path("disk"), 4 * size_of(whole_));
  if (!disk.mounted()) GTEST_SKIP() << "nothing can be mounted here";
  const std::string folder = place_.path("disk/results");
  const auto process = paused(folder);
  disk.fill("other");
  process->signal(SIGINT);
  const Outcome outcome = go_on(*process);
  expect_error(outcome, 4, advice);
  EXPECT_EQ(test::flaws(folder), "");
  EXPECT_FALSE(fs::exists(folder + "/checkpoint.hdf.tmp"));
  fs::remove(place_.path("disk/other"));
  expect_same_when_resumed(folder);
}

TEST_F(Fault, AFileThatMayNotGrowFurther) {
  // First a snapshot does not fit, then a table at some time.
  const std::string folder = place_.path("results");
  Outcome outcome = place_.solve(case_, folder, {}, [] { limit_files_to(20000); });
  expect_error(outcome, 4, folder);
  expect_same_when_resumed(folder);

  case_ = place_.make_case(test::with(
      mode(), "rows", {"output={every = 0.004, snapshot_every = 1.0, restarts = 1000}"}));
  ASSERT_EQ(place_.solve(case_, whole_, {"--force"}).code, 0);
  const std::uintmax_t history = fs::file_size(whole_ + "/history.csv");
  ASSERT_GT(history, 2 * fs::file_size(whole_ + "/snapshots/state_000001.hdf"));
  fs::remove_all(folder);
  // Tables grow at different rates: any may reach the limit first, within a row.
  for (const std::uintmax_t limit : {history / 2, history / 2 + 50, history / 2 + 150}) {
    outcome = place_.solve(case_, folder, {"--force"}, [=] { limit_files_to(limit); });
    expect_error(outcome, 4, ".csv: cannot be written: File too large" + advice);
    EXPECT_EQ(test::flaws(folder), "");
    expect_same_when_resumed(folder);
  }
}

TEST_F(Fault, AReadOnlyDisk) {
  const test::SmallDisk disk(place_.path("disk"), 8 * size_of(whole_));
  if (!disk.mounted()) GTEST_SKIP() << "nothing can be mounted here";
  const std::string folder = place_.copy(whole_, "disk/stopped");
  const std::string finished = place_.copy(whole_, "disk/finished");
  test::stop_after_snapshot(folder, 3);
  ASSERT_TRUE(disk.make_read_only());
  const std::string before = test::contents(folder);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, std::vector<std::string>{"--resume"}}) {
    expect_error(place_.solve(case_, folder, options), 4,
                 folder + ": cannot be written to: Read-only file system");
    expect_error(place_.solve(case_, place_.path("disk/new"), options), 4,
                 "disk/new: cannot be created: Read-only file system");
  }
  EXPECT_TRUE(before == test::contents(folder));
  EXPECT_EQ(place_.solve(case_, finished, {"--resume"}).code, 0) << "there is nothing to write";
}

TEST_F(Fault, AFolderThatCannotBeMade) {
  for (const std::string folder : {"/proc/results", "/sys/results", "/dev/null/results"}) {
    expect_error(place_.solve(case_, folder), 4, folder + ": ");
  }
}

TEST_F(Fault, AFolderOfSomebodyElse) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere; see AReadOnlyDisk";
  const std::string folder = place_.copy(whole_, "stopped");
  test::stop_after_snapshot(folder, 3);
  fs::remove(folder + "/.lock");
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  expect_error(place_.solve(case_, folder, {"--resume"}), 4,
               folder + ": cannot be written to: Permission denied");
  fs::permissions(folder, fs::perms::owner_all);
  expect_same_when_resumed(folder);
}

// --- Folders -------------------------------------------------------------------------------------

TEST_F(Fault, AFolderWithOtherThingsIsNotTouched) {
  const std::string folder = place_.path("mine");
  fs::create_directory(folder);
  std::ofstream(folder + "/thesis.tex") << "years";
  const std::string before = test::contents(folder);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, std::vector<std::string>{"--resume"}}) {
    expect_error(place_.solve(case_, folder, options), 4,
                 folder + ": is not empty and holds no results of suffuse-solver; not touched");
    expect_error(place_.solve(case_, folder + "/thesis.tex", options), 4,
                 "thesis.tex: is a file; expected a folder for the results");
  }
  EXPECT_EQ(test::contents(folder), before);
}

TEST_F(Fault, ResultsOfAnotherSceneAreNotTouched) {
  const std::string other =
      place_.make_case(test::with(mode(), "other", {"name=other", "time.end=1.0"}));
  const std::string before = test::contents(whole_);
  expect_error(place_.solve(other, whole_), 2,
               whole_ + ": holds results of scene \"double\", not of \"other\"; not touched");
  EXPECT_TRUE(before == test::contents(whole_));
}

TEST_F(Fault, ResultsOfAnotherCaseAreReplacedByForceAlone) {
  const std::string refusal =
      whole_ +
      ": holds results of another scene of the name \"double\"; not touched: "
      "choose another folder with -o, or replace them with --force. What "
      "differs:\n  ";
  const std::string before = test::contents(whole_);
  const std::string changed = place_.make_case(test::with(mode(), "changed", {"time.end=0.5"}));
  expect_error(place_.solve(changed, whole_), 2, refusal + "time.end: ");
  const std::string finer =
      place_.make_case(test::with(mode(), "finer", {"points.liquid_per_element=6"}));
  expect_error(place_.solve(finer, whole_), 2,
               refusal + "points.liquid_per_element: 3 there, 6 here\n  the mesh or the points\n");
  expect_error(place_.solve(finer, whole_, {"--resume"}), 2,
               "What differs:\n  points.liquid_per_element: 3 there, 6 here\n  the mesh or the "
               "points\n");
  expect_error(place_.solve(changed, whole_, {"--resume", "--force"}), 2,
               "--resume excludes --force");
  EXPECT_TRUE(before == test::contents(whole_));

  // Runs the same case again, and other cases with --force.
  EXPECT_EQ(place_.solve(case_, whole_).code, 0);
  EXPECT_EQ(place_.solve(changed, whole_, {"--force"}).code, 0);
  EXPECT_EQ(ResultsReader(whole_).scene().scene.time.end, 0.5);
  const std::string other = place_.make_case(test::with(mode(), "other", {"name=other"}));
  EXPECT_EQ(place_.solve(other, whole_, {"--force"}).code, 0);
  EXPECT_EQ(ResultsReader(whole_).scene().scene.name, "other");
}

TEST_F(Fault, ARunThatWasKilledNoLongerRuns) {
  const std::string folder = place_.path("results");
  const auto process = paused(folder);
  EXPECT_EQ(ResultsReader(folder).status(), "running");
  process->signal(SIGKILL);
  EXPECT_EQ(process->wait().code, 128 + SIGKILL);
  EXPECT_EQ(ResultsReader(folder).status(), "stopped without notice");
  // A lock with the name of another host may still be held there.
  const std::string lock = layout::in_folder(folder, layout::lock);
  const std::string name = test::read_file(lock);
  std::ofstream(lock) << "process 12 on elsewhere\n";
  EXPECT_EQ(ResultsReader(folder).status(), "running");
  std::ofstream(lock) << name;
  // The folder as a copy without the lock.
  fs::remove(lock);
  EXPECT_EQ(ResultsReader(folder).status(), "stopped without notice");
  expect_same_when_resumed(folder);
  EXPECT_EQ(ResultsReader(folder).status(), "done");
}

TEST_F(Fault, AReaderDoesNotKeepASolverOut) {
  const std::string folder = place_.path("results");
  const auto process = paused(folder);
  process->signal(SIGKILL);
  process->wait();
  std::atomic<bool> reads = true;
  std::thread reader([&] {
    while (reads) {
      static_cast<void>(may_be_held(folder));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  for (int i = 0; i < 20; ++i) EXPECT_NO_THROW(FolderLock{folder});
  reads = false;
  reader.join();
}

TEST_F(Fault, APipeInThePlaceOfAFileIsNotWaitedFor) {
  for (const char* name :
       {layout::run_info, layout::history, layout::ledger, layout::regions, layout::boundaries}) {
    SCOPED_TRACE(name);
    const std::string folder = place_.path("piped");
    fs::remove_all(folder);
    fs::copy(whole_, folder, fs::copy_options::recursive);
    fs::remove(layout::in_folder(folder, name));
    ASSERT_EQ(::mkfifo(layout::in_folder(folder, name).c_str(), 0666), 0);
    expect_error(place_.solve(case_, folder, {"--resume"}), 4, folder);
  }
}

TEST_F(Fault, TwoSolversOnOneFolder) {
  const std::string folder = place_.path("results");
  const auto first = paused(folder);
  const std::string message = folder + ": another suffuse-solver writes there (process " +
                              std::to_string(first->id()) + " on ";
  expect_error(place_.solve(case_, folder), 4, message);
  expect_error(place_.solve(case_, folder, {"--resume"}), 4, message);
  EXPECT_EQ(go_on(*first).code, 0);
  EXPECT_EQ(test::difference(folder, whole_), "");
  // The lock of a killed run ends with it.
  const auto killed = paused(folder);
  killed->signal(SIGKILL);
  EXPECT_EQ(killed->wait().code, 128 + SIGKILL);
  EXPECT_EQ(test::flaws_after_kill(folder), "");
  expect_same_when_resumed(folder);
}

TEST_F(Fault, ResultsRemovedDuringARun) {
  const std::string folder = place_.path("results");
  const auto process = paused(folder);
  fs::remove_all(folder);
  expect_error(
      go_on(*process), 4,
      folder + " is no longer there: it was removed or renamed while the run wrote into it");
  EXPECT_FALSE(fs::exists(folder));
  expect_same_when_resumed(folder);
}

TEST_F(Fault, SnapshotsReplacedByAFileDuringARun) {
  const std::string folder = place_.path("results");
  const auto process = paused(folder);
  fs::rename(folder + "/snapshots", place_.path("away"));
  std::ofstream(folder + "/snapshots") << "a file";
  expect_error(go_on(*process), 4, advice);
  // Without snapshots the run cannot be resumed, and the rows are kept.
  expect_error(place_.solve(case_, folder, {"--resume"}), 4, "cannot be resumed");
  fs::remove(folder + "/snapshots");
  fs::rename(place_.path("away"), folder + "/snapshots");
  EXPECT_EQ(test::flaws(folder), "");
  expect_same_when_resumed(folder);
}

TEST_F(Fault, ATableRemovedDuringARun) {
  const std::string folder = place_.path("results");
  const auto process = paused(folder);
  fs::remove(folder + "/ledger.csv");
  expect_error(go_on(*process), 4,
               "ledger.csv: was removed or changed by another program while the run wrote to it");
}

// --- Cases ---------------------------------------------------------------------------------------

TEST_F(Fault, ACaseThatIsNone) {
  const std::string folder = place_.path("results");
  const std::string bytes = test::read_file(case_);
  const std::string broken = place_.path("broken.case.h5");
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{100}, bytes.size() / 2, bytes.size() - 1}) {
    std::ofstream(broken, std::ios::binary) << bytes.substr(0, length);
    expect_error(place_.solve(broken, folder), 4, broken + ": ");
  }
  expect_error(place_.solve(whole_ + "/snapshots/mesh_000001.hdf", folder), 4,
               "is not a case file; expected what suffuse-mesher writes");
  expect_error(place_.solve(place_.path("none.h5"), folder), 4, "there is no such file");
  EXPECT_FALSE(fs::exists(folder)) << "nothing is made for a case that cannot be read";
}

TEST_F(Fault, ACaseChangedOrRemovedDuringARun) {
  const std::string folder = place_.path("results");
  const std::string bytes = test::read_file(case_);
  for (const bool removed : {true, false}) {
    const auto process = paused(folder);
    fs::remove(case_);
    if (!removed) std::ofstream(case_, std::ios::binary) << bytes.substr(0, 1000);
    EXPECT_EQ(go_on(*process).code, 0);
    EXPECT_EQ(test::difference(folder, whole_), "");
    std::ofstream(case_, std::ios::binary) << bytes;
  }
}

TEST_F(Fault, ACaseThatCannotBeRunLeavesTheRunBeforeIt) {
  const std::string folder = place_.copy(whole_, "results");
  const std::string before = test::contents(folder);
  const std::string unstable = place_.make_case(
      test::with(mode(), "unstable", {"time={end = 5.0, scheme = \"explicit\", step = 1.0}"}));
  const Outcome outcome = place_.solve(unstable, folder);
  EXPECT_NE(outcome.code, 0);
  EXPECT_TRUE(before == test::contents(folder)) << outcome.error;
  const std::string fresh = place_.path("fresh");
  EXPECT_EQ(place_.solve(unstable, fresh).code, outcome.code);
  EXPECT_FALSE(fs::exists(fresh)) << "not even the lock";
}

// --- Streams and signals -------------------------------------------------------------------------

TEST_F(Fault, StreamsThatAreClosed) {
  const std::string folder = place_.path("results");
  // A message that comes when tables are open must not be written into a table.
  const std::string warned = place_.make_case(
      test::with(mode(), "warned",
                 {R"(boundary[0]={on = "inflow", darcy_flux = 0.012, concentration = 0.7})"}));
  const Outcome undisturbed = place_.solve(warned, whole_, {"--force"});
  ASSERT_NE(undisturbed.error.find("of its volume in fines"), std::string::npos);
  Process process({test::program_folder() + "/suffuse-solver", warned, "-o", folder},
                  place_.path("error.txt"), [] {
                    for (const int stream : {0, 1, 2}) ::close(stream);
                  });
  EXPECT_EQ(process.wait().code, 0);
  EXPECT_EQ(test::difference(folder, whole_), "");
}

TEST_F(Fault, NobodyReadsTheMessages) {
  const std::string folder = place_.path("results");
  const std::string explicit_case = place_.make_case(test::five_modes()[2]);
  const Outcome undisturbed = place_.solve(explicit_case, whole_, {"--force"});
  ASSERT_NE(undisturbed.error, "") << "a run that has something to say";
  Process process({test::program_folder() + "/suffuse-solver", explicit_case, "-o", folder},
                  place_.path("error.txt"), [] {
                    std::array<int, 2> ends{};
                    if (::pipe(ends.data()) != 0) ::_exit(1);
                    ::close(ends[0]);
                    ::dup2(ends[1], STDOUT_FILENO);
                    ::dup2(ends[1], STDERR_FILENO);
                  });
  EXPECT_EQ(process.wait().code, 0);
  EXPECT_EQ(test::difference(folder, whole_), "");
}

TEST_F(Fault, AnImpatientUser) {
  const std::string folder = place_.path("results");
  const auto process = paused(folder);
  process->signal(SIGINT);
  process->signal(SIGCONT);
  while (process->running()) process->signal(SIGINT);
  EXPECT_EQ(process->wait().code, 130);
  EXPECT_TRUE(fs::exists(folder + "/checkpoint.hdf"));
  EXPECT_EQ(test::flaws(folder), "");
  expect_same_when_resumed(folder);
}

TEST_F(Fault, ALostTerminalEndsARunUnlessNohupSaysNo) {
  const std::string folder = place_.path("results");
  const auto process = paused(folder);
  process->signal(SIGHUP);
  EXPECT_EQ(go_on(*process).code, 130);
  EXPECT_TRUE(fs::exists(folder + "/checkpoint.hdf"));
  expect_same_when_resumed(folder);
  const auto detached = paused(folder, {}, [] { std::signal(SIGHUP, SIG_IGN); });
  detached->signal(SIGHUP);
  EXPECT_EQ(go_on(*detached).code, 0);
  EXPECT_EQ(test::difference(folder, whole_), "");
}

// --- The other programs --------------------------------------------------------------------------

TEST_F(Fault, MesherWithClosedStreams) {
  const std::string made = test::read_file(case_);
  const std::string again = place_.path("again.case.h5");
  std::vector<std::string> words{test::program_folder() + "/suffuse-mesher",
                                 place_.path("double_point.toml"), "-o", again};
  for (const std::string& set : mode().sets) words.insert(words.end(), {"--set", set});
  Process process(words, place_.path("error.txt"), [] {
    for (const int stream : {0, 1, 2}) ::close(stream);
  });
  EXPECT_EQ(process.wait().code, 0);
  EXPECT_TRUE(test::read_file(again) == made);
}

TEST_F(Fault, WhatPostWritesIsWholeOrAsItWas) {
  const std::vector<std::vector<std::string>> commands{
      {"ledger", whole_, "--csv"},
      {"history", whole_, "--csv"},
      {"table", whole_, "--csv"},
      {"sample", whole_, "--time", "5", "--line", "0.1,0.1:0.4,0.4", "--count", "500", "--fields",
       "porosity,pressure", "--csv"},
      {"figure", "porosity", whole_, "-o"},
      {"figure", "porosity", whole_, "-o", ".svg"},
      {"figure", "porosity", whole_, "-o", ".pdf"},
  };
  for (auto command : commands) {
    SCOPED_TRACE(command.front());
    std::string name = command.front() == "figure" ? "out.png" : "out.csv";
    if (command.back().starts_with('.')) {
      name = "out" + command.back();
      command.pop_back();
    }
    fs::create_directories(place_.path("made"));
    const std::string file = place_.path("made/" + name);
    std::ofstream(file) << "as it was\n";
    std::vector<std::string> words{test::program_folder() + "/suffuse-post"};
    words.insert(words.end(), command.begin(), command.end());
    words.push_back(file);
    Process process(words, place_.path("error.txt"), [] { limit_files_to(64); });
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.code, 4) << outcome.error;
    EXPECT_EQ(test::read_file(file), "as it was\n");
    fs::remove(file);
    EXPECT_TRUE(fs::is_empty(place_.path("made"))) << test::contents(place_.path("made"));
  }
}

TEST_F(Fault, ExportLeavesWholeFilesAlone) {
  const auto export_to = [&](const std::string& folder) {
    Process process({test::program_folder() + "/suffuse-post", "export", whole_, "-o", folder},
                    place_.path("error.txt"));
    return process.wait();
  };
  const std::string complete = place_.path("complete");
  ASSERT_EQ(export_to(complete).code, 0);
  for (const double share : {0.1, 0.5, 0.9}) {
    SCOPED_TRACE(share);
    const test::SmallDisk disk(
        place_.path("disk"),
        static_cast<std::uintmax_t>(share * static_cast<double>(size_of(complete))));
    if (!disk.mounted()) GTEST_SKIP() << "nothing can be mounted here";
    const std::string folder = place_.path("disk/made");
    expect_error(export_to(folder), 4, "is the disk full?\n");
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
      ++files;
      const std::string whole = complete + "/" + entry.path().filename().string();
      EXPECT_EQ(test::read_file(entry.path().string()), test::read_file(whole));
    }
    EXPECT_TRUE(files > 0 || share < 0.4);
  }
}

}  // namespace faults_test
}  // namespace suffuse
