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
#include "driver/rank_refusals.hpp"
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

/// The plan on this rank.
ModelOptions options_of(const Plan& plan, const std::shared_ptr<const RankPart>& part,
                        bool is_resumed) {
  ModelOptions options = plan;
  options.part = part;
  if (is_resumed) options.soil_start = SoilStart::stress_later;
  return options;
}

/// A run that checks every output and writes it to a results folder. On several ranks each has its
/// part of the model, and rank 0 the folder.
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
        ranks_(*options.ranks),
        is_first_(ranks_.rank() == 0),
        resume_command_(std::move(resume_command)),
        case_digest_(digest_of(case_)),
        folder_(starting_point.folder),
        part_(take_part()),
        loop_(local_case_ ? *local_case_ : case_,
              options_of(plan, part_, starting_point.from.has_value()),
              source ? &source->state : nullptr),
        notes_{.checks = RowChecks(case_.document.scene, plan.row_limits),
               .origin = source ? source->sentences : std::vector<std::string>()},
        progress_(starting_point.from ? starting_point.from->time : 0.0,
                  case_.document.scene.time.end, starts_from_rest(starting_point),
                  run.quiet || !is_first_) {
    together(ranks_, [&] { open_results(std::move(starting_point)); });
    // The model has its own points now.
    case_.liquid_points = {};
    if (local_case_) local_case_->liquid_points = {};
  }

  ExitCode run() {
    try {
      together(ranks_, [&] { write_info("running", ""); });
      loop_.run(*this);
      together(ranks_, [&] { finish_writing(); });
      progress_.finish();
      if (!loop_.finished()) return stop();
      together(ranks_, [&] {
        // This precedes the status "done", after which nothing would remove the file.
        if (writer_) writer_->remove_checkpoint();
        write_info("done", "");
      });
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
    const auto of_first = ranks_.of_first({text.begin(), text.end()});  // times in it differ
    notes_.warnings.emplace_back(of_first.begin(), of_first.end());
    if (is_first_) progress_.say("suffuse-solver: warning: " + text);
  }

  void write_row(const FlowState<Dim>& flow) override {
    OutputRows rows(loop_.model(), flow);
    rows.history.energy = notes_.energy.at(rows.history);
    for (const std::string& warning : notes_.checks.check(rows.history)) warn(warning);
    together(ranks_, [&] {
      if (writer_) rows.append_to(*writer_);
    });
  }

  /// Writes the files while the run continues.
  void write_snapshot(const FlowState<Dim>& flow) override {
    // Only one snapshot at a time is kept in memory.
    together(ranks_, [&] { finish_writing(); });
    Snapshot snapshot = loop_.model().snapshot(flow);
    snapshot.restart = restart_point();
    if (writer_) {
      // If no thread can be started, the snapshot is written in `finish_writing`.
      writing_ = std::async(std::launch::async | std::launch::deferred,
                            [this, snapshot = std::move(snapshot)]() mutable {
                              writer_->write_snapshot(std::move(snapshot));
                            });
    }
    // No run could continue from rows without a snapshot.
    if (loop_.schedule().past_snapshots().count == 1) together(ranks_, [&] { finish_writing(); });
    since_saved_ = Stopwatch();
  }

  bool continue_after_interval() override {
    progress_.report(loop_.model().time(), loop_.model().last_step(),
                     loop_.model().solid().has_inertia());
    // The clock of rank 0 decides.
    const bool is_due =
        is_first_ && run_.checkpoint_every > 0.0 && since_saved_.seconds() >= run_.checkpoint_every;
    if (any_of_all(ranks_, is_due)) write_checkpoint();
    return true;
  }

 private:
  /// Takes the part of this rank out of the case, if there are several.
  std::shared_ptr<const RankPart> take_part() {
    OwnPart<Dim> taken = own_part(case_, options_.ranks);
    local_case_ = std::move(taken.own);
    if (!is_first_) {
      case_.mesh = {};
      case_.solid_points = {};
      case_.liquid_points = {};
    }
    return taken.part;
  }

  /// Replaces the results of an earlier run, after everything that can fail because of the case.
  void open_results(StartingPoint starting_point) {
    for (const std::string& warning : plan_.warnings) warn(warning);
    if (starting_point.from) {
      StateArchive state(std::move(starting_point.from->state), loop_.model().shared_state());
      state(loop_, notes_);
      state.finish();
      resumed_at_ = starting_point.from->time;
    }
    if (!is_first_) return;
    if (starting_point.from) {
      writer_.emplace(folder_, case_, std::move(starting_point.lock), *starting_point.from);
    } else {
      writer_.emplace(folder_, case_, std::move(starting_point.lock));
    }
  }

  [[nodiscard]] bool starts_from_rest(const StartingPoint& starting_point) const {
    const Scene& scene = case_.document.scene;
    return !starting_point.from && scene.initial_flow == InitialFlow::rest &&
           scene.initial_from.empty();
  }

  ExitCode stop() {
    write_checkpoint();
    together(ranks_, [&] { write_info("interrupted", ""); });
    std::ostringstream line;
    line << "interrupted at t = " << loop_.model().time()
         << " s; what is written is complete. To go on:\n  " << resume_command_;
    if (is_first_) progress_.say(line.str());
    return ExitCode::interrupted;
  }

  /// Writes row and snapshot of the last state in equilibrium, also between two output times. A
  /// resumed run removes this output.
  void write_last_equilibrium() {
    const double now = loop_.model().time();
    const OutputSchedule& schedule = loop_.schedule();
    const FlowState<Dim> flow = loop_.model().flow_state();
    together(ranks_, [&] { finish_writing(); });
    if (schedule.past_rows().last < now) write_row(flow);
    if (schedule.past_snapshots().last < now) {
      Snapshot snapshot = loop_.model().snapshot(flow);
      together(ranks_, [&] {
        if (writer_) writer_->write_snapshot(std::move(snapshot));
      });
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

  /// Waits for the snapshot that is being written, on rank 0. Throws its exception.
  void finish_writing() {
    if (writing_.valid()) writing_.get();
  }

  /// Does not wait for other ranks, which may not have failed.
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
    return message +
           "\nWhat was written before is complete. When this is corrected, go on with:\n  " +
           resume_command_;
  }

  void write_checkpoint() {
    const RestartPoint point = restart_point();
    together(ranks_, [&] {
      finish_writing();
      if (writer_) writer_->write_checkpoint(point);
    });
    since_saved_ = Stopwatch();
  }

  RestartPoint restart_point() {
    RestartPoint point = loop_.restart_point(notes_);
    point.no_skip = options_.no_skip;
    point.case_digest = case_digest_;
    return point;
  }

  void write_info(const std::string& status, const std::string& message) {
    if (!writer_) return;
    RunInfo info;
    info.status = status;
    info.message = message;
    info.steps = loop_.model().steps();
    info.solid_points = case_.document.scene.moves() ? loop_.model().solid().soils().points().size()
                                                     : case_.solid_points.size();
    info.liquid_points = loop_.model().liquid_points();
    info.elements = case_.mesh.element_count();
    info.threads = options_.threads;
    info.ranks = ranks_.count();
    info.wall_seconds = since_start_.seconds();
    info.resumed_at = resumed_at_;
    info.memory_bytes = peak_memory();
    info.passes = loop_.model().passes();
    info.plan = notes_.origin;
    info.plan.insert(info.plan.end(), plan_.sentences.begin(), plan_.sentences.end());
    info.warnings = notes_.warnings;
    writer_->write_run_info(info);
  }

  Case<Dim> case_;  ///< without mesh and points on ranks that have no folder
  const Plan& plan_;
  const SolverOptions& options_;
  const RunOptions& run_;
  const Ranks& ranks_;
  bool is_first_;  ///< this is rank 0, which has the folder
  std::string resume_command_;
  std::string case_digest_;
  std::string folder_;
  std::optional<Case<Dim>> local_case_;  ///< nothing if this program is alone
  std::shared_ptr<const RankPart> part_;
  Stopwatch since_start_;
  Stopwatch since_saved_;  ///< since the last snapshot or checkpoint
  RunLoop<Dim> loop_;
  RunNotes notes_;
  Progress progress_;
  std::optional<double> resumed_at_;  ///< s
  std::optional<ResultsWriter<Dim>> writer_;
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

/// Gives the starting point that rank 0 has found to the other ranks, which have no folder.
void share(const Ranks& ranks, const std::string& folder, std::optional<StartingPoint>& found) {
  bool exists = found.has_value();
  bool is_state = exists && found->from;
  RestartPoint none;
  RestartPoint& point = is_state ? *found->from : none;
  const auto pass = [&](StateArchive& archive) {
    archive(exists, is_state, point.time, point.rows, point.snapshots, point.state);
  };
  StateArchive sent;
  if (ranks.rank() == 0) pass(sent);
  StateArchive received(ranks.of_first(sent.finish()));
  if (ranks.rank() == 0) return;
  pass(received);
  if (!exists) return;
  found.emplace().folder = folder;
  if (is_state) found->from = std::move(point);
}

}  // namespace

template <int Dim>
int run_case(Case<Dim> c, const Plan& plan, const SolverOptions& options, const std::string& folder,
             const RunOptions& run, const std::string& case_path) {
  const Ranks& ranks = *options.ranks;
  if (ranks.count() > 1) refuse_on_ranks(c);
  catch_interrupts();
  std::optional<StartingPoint> starting_point;
  together(ranks, [&] {
    if (ranks.rank() > 0) return;
    if (run.resume) {
      starting_point = find_starting_point(c, folder, options);
    } else {
      const Replace replace = run.force ? Replace::any : Replace::same_case;
      starting_point = StartingPoint{folder, std::nullopt, lock_for_results(folder, c, replace)};
    }
  });
  if (ranks.count() > 1) share(ranks, folder, starting_point);
  const bool speaks = !run.quiet && ranks.rank() == 0;
  if (!starting_point) {
    if (speaks) std::fprintf(stderr, "%s is complete: nothing to resume\n", folder.c_str());
    return static_cast<int>(ExitCode::done);
  }
  if (run.resume && speaks) {
    if (starting_point->from) {
      std::fprintf(stderr, "going on from t = %g s\n", starting_point->from->time);
    } else {
      std::fprintf(stderr, "%s has no snapshot to go on from: begins anew\n", folder.c_str());
    }
  }
  // A resumed run has all that it needs in its own state.
  std::optional<SourceRun<Dim>> source;
  if (!starting_point->from) together(ranks, [&] { source = read_source_run(c, options); });
  if (source) refuse_own_source(c.document, *source, folder);
  const std::string program =
      ranks.count() == 1 ? "suffuse-solver "
                         : "mpirun -n " + std::to_string(ranks.count()) + " suffuse-solver-mpi ";
  const std::string resume_command = program + quoted(case_path) + " -o " + quoted(folder) +
                                     (options.no_skip ? " --no-skip" : "") + " --resume";
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
