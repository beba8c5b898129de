#include "driver/run.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <future>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "common/errors.hpp"
#include "driver/interrupt.hpp"
#include "driver/memory.hpp"
#include "driver/progress.hpp"
#include "driver/run_loop.hpp"
#include "driver/run_notes.hpp"
#include "driver/source_run.hpp"
#include "driver/starting_point.hpp"
#include "driver/stopwatch.hpp"
#include "results/writer.hpp"

namespace suffuse {
namespace {

/// Quotes a word for a shell.
std::string quoted(const std::string& word) {
  const bool plain = std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./+=:@%,").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain && !word.empty()) return word;
  std::string result = "'";
  for (const char c : word) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

/// A run that checks every output and writes it to a results folder.
template <int Dim>
class Run final : public OutputSink<Dim> {
 public:
  Run(Case<Dim> c, const Plan& plan, const SolverOptions& options, StartingPoint starting_point,
      const RunOptions& run, std::string resume_command,
      const std::optional<SourceRun<Dim>>& source)
      : case_(std::move(c)),
        plan_(plan),
        options_(options),
        run_(run),
        resume_command_(std::move(resume_command)),
        case_digest_(digest_of(case_)),
        folder_(starting_point.folder),
        loop_(case_, plan, source ? &source->state : nullptr),
        notes_{.checks = {case_.document.scene, plan.speed_that_drag_follows, plan.obtuse_elements},
               .origin = source ? source->sentences : std::vector<std::string>()},
        progress_(starting_point.from ? starting_point.from->time : 0.0,
                  case_.document.scene.time.end, starts_from_rest(starting_point), run.quiet),
        writer_(open_results(std::move(starting_point))) {
    // The model has its own points now.
    case_.liquid_points = {};
  }

  ExitCode run() {
    try {
      write_info("running", "");
      loop_.run(*this);
      finish_writing();
      progress_.finish();
      if (!loop_.finished()) return stop();
      // This precedes the status "done", after which nothing would remove the file.
      writer_.remove_checkpoint();
      write_info("done", "");
      return ExitCode::done;
    } catch (const EquilibriumLost& error) {
      progress_.finish();
      fail_in_last_equilibrium(error.what());
      throw NumericalError(std::string(error.what()) +
                           "\nWhat is written is complete, with the last equilibrium in the last "
                           "row and the last snapshot");
    } catch (const FileError& error) {
      progress_.finish();
      note_failure(error.what());
      throw FileError(with_advice(error.what()));
    } catch (const std::exception& error) {
      progress_.finish();
      note_failure(error.what());
      throw;
    }
  }

  void warn(const std::string& text) override {
    notes_.warnings.push_back(text);
    progress_.say("suffuse-solver: warning: " + text);
  }

  void write_row(const FlowState<Dim>& flow) override {
    HistoryRow row = loop_.model().history_row(flow);
    row.energy = notes_.energy.at(row);
    for (const std::string& warning : notes_.checks.check(row)) warn(warning);
    writer_.append_history(row);
    append_tables(writer_, loop_.model(), flow);
  }

  /// Writes the files while the run continues.
  void write_snapshot(const FlowState<Dim>& flow) override {
    // Only one snapshot at a time is kept in memory.
    finish_writing();
    Snapshot snapshot = loop_.model().snapshot(flow);
    snapshot.restart = restart_point();
    // If no thread can be started, the snapshot is written in `finish_writing`.
    writing_ = std::async(std::launch::async | std::launch::deferred,
                          [this, snapshot = std::move(snapshot)]() mutable {
                            writer_.write_snapshot(std::move(snapshot));
                          });
    // No run could continue from rows without a snapshot.
    if (loop_.schedule().past_snapshots().count == 1) finish_writing();
    since_saved_ = Stopwatch();
  }

  bool continue_after_interval() override {
    progress_.report(loop_.model().time(), loop_.model().last_step(),
                     loop_.model().solid().has_inertia());
    if (run_.checkpoint_every > 0.0 && since_saved_.seconds() >= run_.checkpoint_every) {
      write_checkpoint();
    }
    return true;
  }

 private:
  /// Replaces the results of an earlier run, after everything that can fail because of the case.
  ResultsWriter<Dim> open_results(StartingPoint starting_point) {
    for (const std::string& warning : plan_.warnings) warn(warning);
    if (!starting_point.from) return {starting_point.folder, case_, std::move(starting_point.lock)};
    StateArchive state(std::move(starting_point.from->state));
    state(loop_, notes_);
    state.finish();
    resumed_at_ = starting_point.from->time;
    return {starting_point.folder, case_, std::move(starting_point.lock), *starting_point.from};
  }

  [[nodiscard]] bool starts_from_rest(const StartingPoint& starting_point) const {
    const Scene& scene = case_.document.scene;
    return !starting_point.from && scene.initial_flow == InitialFlow::rest &&
           scene.initial_from.empty();
  }

  ExitCode stop() {
    write_checkpoint();
    write_info("interrupted", "");
    std::ostringstream line;
    line << "interrupted at t = " << loop_.model().time()
         << " s; what is written is complete. To go on:\n  " << resume_command_;
    progress_.say(line.str());
    return ExitCode::interrupted;
  }

  /// Writes row and snapshot of the last state in equilibrium, also between two output times. A
  /// resumed run removes this output.
  void write_last_equilibrium() {
    const double now = loop_.model().time();
    const OutputSchedule& schedule = loop_.schedule();
    const FlowState<Dim> flow = loop_.model().flow_state();
    finish_writing();
    if (schedule.past_rows().last < now) write_row(flow);
    if (schedule.past_snapshots().last < now) {
      writer_.write_snapshot(loop_.model().snapshot(flow));
    }
    write_checkpoint();
  }

  /// Notes the failure of the run, also if its last state cannot be written.
  void fail_in_last_equilibrium(const std::string& message) {
    try {
      write_last_equilibrium();
    } catch (const std::exception&) {
      note_failure(message);
      throw;
    }
    note_failure(message);
  }

  /// Waits for the snapshot that is being written. Throws its exception.
  void finish_writing() {
    if (writing_.valid()) writing_.get();
  }

  void note_failure(const std::string& message) {
    try {
      write_info("failed", message);
      finish_writing();
    } catch (const std::exception&) {
      // The disk may be full.
    }
  }

  [[nodiscard]] std::string with_advice(const std::string& message) const {
    if (!std::filesystem::exists(folder_)) {
      return message + "\n" + folder_ +
             " is no longer there: it was removed or renamed while the run wrote into it";
    }
    return message + "\nWhat was written before is complete. When this is mended, go on with:\n  " +
           resume_command_;
  }

  void write_checkpoint() {
    finish_writing();
    writer_.write_checkpoint(restart_point());
    since_saved_ = Stopwatch();
  }

  RestartPoint restart_point() {
    RestartPoint point = loop_.restart_point(notes_);
    point.no_skip = options_.no_skip;
    point.case_digest = case_digest_;
    return point;
  }

  void write_info(const std::string& status, const std::string& message) {
    RunInfo info;
    info.status = status;
    info.message = message;
    info.steps = loop_.model().steps();
    info.solid_points = case_.solid_points.size();
    info.liquid_points = loop_.model().liquid_points();
    info.elements = case_.mesh.element_count();
    info.threads = options_.threads;
    info.wall_seconds = since_start_.seconds();
    info.resumed_at = resumed_at_;
    info.memory_bytes = peak_memory();
    info.passes = loop_.model().passes();
    info.plan = notes_.origin;
    info.plan.insert(info.plan.end(), plan_.sentences.begin(), plan_.sentences.end());
    info.warnings = notes_.warnings;
    writer_.write_run_info(info);
  }

  Case<Dim> case_;
  const Plan& plan_;
  const SolverOptions& options_;
  const RunOptions& run_;
  std::string resume_command_;
  std::string case_digest_;
  std::string folder_;
  Stopwatch since_start_;
  Stopwatch since_saved_;  ///< since the last snapshot or checkpoint
  RunLoop<Dim> loop_;
  RunNotes notes_;
  Progress progress_;
  std::optional<double> resumed_at_;  ///< s
  ResultsWriter<Dim> writer_;
  /// The writing of a snapshot, during which no other thread uses HDF5; tables still grow.
  std::future<void> writing_;
};

/// Refuses to replace the results of the earlier run that this run starts from.
template <int Dim>
void refuse_own_source(const SceneDocument& document, const SourceRun<Dim>& source,
                       const std::string& folder) {
  std::error_code none;
  if (!std::filesystem::equivalent(source.folder, folder, none)) return;
  throw InputError(document.locate("initial.from") + ": initial.from: got " + folder +
                   ", the folder that this run writes into; expected another one: choose it with "
                   "-o");
}

}  // namespace

template <int Dim>
int run_case(Case<Dim> c, const Plan& plan, const SolverOptions& options, const std::string& folder,
             const RunOptions& run, const std::string& case_path) {
  catch_interrupts();
  std::optional<StartingPoint> starting_point;
  if (run.resume) {
    starting_point = find_starting_point(c, folder, options);
  } else {
    const Replace replace = run.force ? Replace::any : Replace::same_case;
    starting_point = StartingPoint{folder, std::nullopt, lock_for_results(folder, c, replace)};
  }
  if (!starting_point) {
    if (!run.quiet) std::fprintf(stderr, "%s is complete: nothing to resume\n", folder.c_str());
    return static_cast<int>(ExitCode::done);
  }
  if (run.resume && !run.quiet) {
    if (starting_point->from) {
      std::fprintf(stderr, "going on from t = %g s\n", starting_point->from->time);
    } else {
      std::fprintf(stderr, "%s has no snapshot to go on from: begins anew\n", folder.c_str());
    }
  }
  // A resumed run has all that it needs in its own state.
  std::optional<SourceRun<Dim>> source;
  if (!starting_point->from) source = read_source_run(c, options.threads);
  if (source) refuse_own_source(c.document, *source, folder);
  const std::string resume_command = "suffuse-solver " + quoted(case_path) + " -o " +
                                     quoted(folder) + (options.no_skip ? " --no-skip" : "") +
                                     " --resume";
  Run<Dim> started(std::move(c), plan, options, std::move(*starting_point), run, resume_command,
                   source);
  source.reset();
  return static_cast<int>(started.run());
}

template int run_case(Case<2>, const Plan&, const SolverOptions&, const std::string&,
                      const RunOptions&, const std::string&);
template int run_case(Case<3>, const Plan&, const SolverOptions&, const std::string&,
                      const RunOptions&, const std::string&);

}  // namespace suffuse
