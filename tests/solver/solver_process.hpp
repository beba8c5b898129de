#pragma once

/// The programs, run as by a user, and the files that they leave.

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "mesher/temporary_folder.hpp"

namespace suffuse::test {

/// How a program ended.
struct Outcome {
  int code = 0;       ///< exit code; 128 + signal where it was killed
  std::string error;  ///< output on stderr
};

/// A program that runs.
class Process {
 public:
  /// `words.front()` is the program; stderr goes to the file `error`. `prepare` is called in the
  /// new process before it becomes the program.
  Process(
      const std::vector<std::string>& words, std::string error,
      const std::function<void()>& prepare = [] {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  /// Kills the program if it still runs.
  ~Process();

  [[nodiscard]] pid_t id() const { return id_; }
  [[nodiscard]] bool running();
  void signal(int number) const;
  /// Waits until it ends; kills it after two minutes.
  Outcome wait();

 private:
  pid_t id_ = -1;
  std::string error_;
  int status_ = 0;
  bool ended_ = false;
};

/// Waits for `condition` while `process` runs. Returns whether it was fulfilled.
bool wait_for(Process& process, const std::function<bool()>& condition);

/// A mode of the solver, and its settings for a run.
struct Mode {
  std::string name;
  std::string scene;              ///< the whole text
  std::vector<std::string> sets;  ///< arguments of --set
};
std::ostream& operator<<(std::ostream& out, const Mode& mode);

/// Single-point explicit and implicit; double-point mixed explicit, implicit, at material points.
/// Runs of a tenth of a second of wall time with fifty rows and ten snapshots, in which all fields
/// change. Every snapshot keeps its state.
std::vector<Mode> five_modes();
/// Single-point implicit: soil that is loaded, loses fines, settles and yields.
Mode moving_mode();
/// A mode with additional --set arguments.
Mode with(Mode mode, const std::string& name, const std::vector<std::string>& sets);

/// The words of the solver's command line, with --quiet.
std::vector<std::string> solver_words(const std::string& case_path, const std::string& results,
                                      const std::vector<std::string>& options = {});

/// A folder in which a scene is meshed and run.
class Workplace {
 public:
  /// Meshes the scene into "NAME.case.h5". Throws when that fails.
  std::string make_case(const Mode& mode) const;
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  /// Runs the solver to its end into the folder `results`.
  [[nodiscard]] Outcome solve(
      const std::string& case_path, const std::string& results,
      const std::vector<std::string>& options = {},
      const std::function<void()>& prepare = [] {}) const;
  /// A copy of a results folder. Returns its path.
  [[nodiscard]] std::string copy(const std::string& results, const std::string& name) const;

 private:
  TemporaryFolder folder_;
};

/// Changes the folder of a finished run into that of a run killed between snapshot `index` and the
/// next: later snapshots and the end are missing, rows go on.
void stop_after_snapshot(const std::string& results, int index);

/// Number of whole lines of a file; 0 where there is none.
long lines_in(const std::string& path);
int snapshots_in(const std::string& results);

/// All differences between two results folders: files byte by byte, except the lock and run.json,
/// in which durations, threads, memory and the place of resumption may differ. Empty if there are
/// none.
std::string difference(const std::string& results, const std::string& others);

/// All bytes of all files of a folder, including the lock; with their names.
std::string contents(const std::string& folder);

/// Faults that the results have even if the solver was killed: a snapshot that a series names
/// cannot be read completely, a row of a table has missing cells, run.json does not name the scene.
/// Empty if there are none.
std::string flaws_after_kill(const std::string& results);

/// In addition, tables that end within a row: the system may cut what a killed program is writing.
std::string flaws(const std::string& results);

}  // namespace suffuse::test
