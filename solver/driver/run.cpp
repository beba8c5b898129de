#include "driver/run.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "case/errors.hpp"
#include "driver/interrupt.hpp"
#include "driver/memory.hpp"
#include "driver/output_schedule.hpp"
#include "driver/progress.hpp"

namespace suffuse {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// In words for a shell.
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

/// Where a run starts or goes on.
struct StartingPoint {
  std::string folder;
  std::optional<RestartPoint> from;
  FolderLock lock;
};

template <int Dim>
class Run {
 public:
  Run(Case<Dim> c, const Plan& plan, const SolverOptions& options, StartingPoint starting_point,
      const RunOptions& run, std::string how_to_go_on)
      : case_(std::move(c)),
        plan_(plan),
        options_(options),
        run_(run),
        how_to_go_on_(std::move(how_to_go_on)),
        case_digest_(digest_of(case_)),
        folder_(starting_point.folder),
        model_(make_model(case_, plan)),
        progress_(case_.document.scene.time.end, run.quiet),
        schedule_(case_.document.scene),
        writer_(open_results(std::move(starting_point))) {
    // The model has points of its own by now.
    case_.liquid_points = {};
  }

  ExitCode run() {
    try {
      loop();
      progress_.finish();
      if (!schedule_.finished()) return stop();
      // Before it says that it is done: nobody looks for what is left over after that.
      writer_.remove_checkpoint();
      write_info("done", "");
      return ExitCode::done;
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

 private:
  /// Comes after all that may fail for reasons of the case: an earlier run is still there then.
  ResultsWriter<Dim> open_results(StartingPoint starting_point) {
    for (const std::string& warning : plan_.warnings) warn(warning);
    if (!starting_point.from) return {starting_point.folder, case_, std::move(starting_point.lock)};
    restore(std::move(starting_point.from->state));
    resumed_at_ = starting_point.from->time;
    return {starting_point.folder, case_, std::move(starting_point.lock), *starting_point.from};
  }

  void loop() {
    write_info("running", "");
    if (!resumed_at_) output();
    while (!schedule_.finished() && !interrupted()) {
      model_->advance(schedule_.next());
      for (const std::string& warning : model_->take_warnings()) warn(warning);
      output();
      progress_.report(model_->time(), model_->last_step());
      if (run_.checkpoint_every > 0.0 && seconds_since(last_kept_) >= run_.checkpoint_every) {
        keep_checkpoint();
      }
    }
  }

  ExitCode stop() {
    keep_checkpoint();
    write_info("interrupted", "");
    std::ostringstream line;
    line << "interrupted at t = " << model_->time()
         << " s; what is written is complete. To go on:\n  " << how_to_go_on_;
    progress_.say(line.str());
    return ExitCode::interrupted;
  }

  void note_failure(const std::string& message) {
    try {
      write_info("failed", message);
    } catch (const FileError&) {
      // The disk that has no room for results may have none for this either.
    }
  }

  [[nodiscard]] std::string with_advice(const std::string& message) const {
    if (!std::filesystem::exists(folder_)) {
      return message + "\n" + folder_ +
             " is no longer there: it was removed or renamed while the run wrote into it";
    }
    return message + "\nWhat was written before is complete. When this is mended, go on with:\n  " +
           how_to_go_on_;
  }

  /// What is due now. The row comes first: the snapshot with the state of the run then finds all
  /// those before it.
  void output() {
    const OutputSchedule::Due due = schedule_.take(model_->time());
    if (!due.row && !due.snapshot) return;
    const FlowState<Dim> flow = model_->flow_state();
    if (due.row) write_row(flow);
    if (!due.snapshot) return;
    Snapshot snapshot = model_->snapshot(flow);
    snapshot.restart = restart_point();
    writer_.write_snapshot(std::move(snapshot));
    last_kept_ = Clock::now();
  }

  void write_row(const FlowState<Dim>& flow) {
    const HistoryRow row = model_->history_row(flow);
    check_finite(row);
    check_compression(row);
    warn_of_speed(row.speed_max);
    warn_of_carried_momentum(row.speed_max);
    writer_.append_history(row);
    writer_.append_ledger(model_->ledger());
    const std::vector<RegionRow> regions = model_->region_rows();
    writer_.append_regions(regions);
  }

  void keep_checkpoint() {
    writer_.write_checkpoint(restart_point());
    last_kept_ = Clock::now();
  }

  RestartPoint restart_point() {
    RestartPoint point;
    point.time = model_->time();
    point.rows = schedule_.rows().past();
    point.snapshots = schedule_.snapshots().past();
    point.no_skip = options_.no_skip;
    point.case_digest = case_digest_;
    StateArchive state;
    archive(state);
    point.state = state.finish();
    return point;
  }

  void restore(std::vector<std::uint8_t> bytes) {
    StateArchive state(std::move(bytes));
    archive(state);
    state.finish();
  }

  void archive(StateArchive& state) {
    state(*model_, schedule_, speed_warned_, momentum_warned_, compression_warned_, warnings_);
  }

  static void check_finite(const HistoryRow& row) {
    for (const auto& [name, member] : history_columns) {
      if (std::isfinite(row.*member)) continue;
      std::ostringstream message;
      message << name << " is no longer a number at t = " << row.t << " s";
      throw NumericalError(message.str());
    }
  }

  /// The equation of state is that of water hardly compressed.
  void check_compression(const HistoryRow& row) {
    const double modulus = case_.document.scene.liquid.bulk_modulus;
    // What scatters about the pressures of the nodes is pressure too: a flow that runs away shows
    // there first.
    const double pressure =
        std::max({std::abs(row.pressure_min), std::abs(row.pressure_max), row.pressure_scatter});
    std::ostringstream message;
    message << "pressures reach " << pressure << " Pa at t = " << row.t << " s, "
            << pressure / modulus << " times the water's bulk modulus";
    if (pressure >= modulus) {
      throw NumericalError(
          message.str() +
          ": water cannot be compressed like that; look at the boundary conditions");
    }
    if (pressure < 0.1 * modulus || compression_warned_) return;
    compression_warned_ = true;
    warn(message.str() + ": the liquid is no longer weakly compressible");
  }

  /// Scaled masses must stay light against the waves they carry: S <= (0.1 c / v)^2.
  void warn_of_speed(double speed) {
    const double scaling = case_.document.scene.time.mass_scaling;
    const LiquidProperties& liquid = case_.document.scene.liquid;
    const double wave = std::sqrt(liquid.bulk_modulus / liquid.density);
    if (speed_warned_ || scaling <= 1.0 || speed * std::sqrt(scaling) <= 0.1 * wave) return;
    speed_warned_ = true;
    std::ostringstream message;
    message << "mass_scaling = " << scaling << " slows the pressure wave to "
            << wave / std::sqrt(scaling) << " m/s, less than ten times the flow's " << speed
            << " m/s: pressures are not to be trusted";
    warn(message.str());
  }

  /// Pressure is convected and momentum is not, so that waves between an inlet and an outlet grow
  /// by 1 + v / c with every way back unless drag takes as much.
  void warn_of_carried_momentum(double speed) {
    if (momentum_warned_ || !(speed > plan_.speed_that_drag_follows)) return;
    momentum_warned_ = true;
    std::ostringstream message;
    message << "the liquid reaches " << speed << " m/s; above " << plan_.speed_that_drag_follows
            << " m/s it passes the model before drag brings it to its speed, and the momentum that "
               "it carries along is not in the equations: pressures and fluxes are not to be "
               "trusted";
    warn(message.str());
  }

  void warn(const std::string& text) {
    warnings_.push_back(text);
    progress_.say("suffuse-solver: warning: " + text);
  }

  void write_info(const std::string& status, const std::string& message) {
    RunInfo info;
    info.status = status;
    info.message = message;
    info.steps = model_->steps();
    info.solid_points = case_.solid_points.size();
    info.liquid_points = model_->liquid_points();
    info.elements = case_.mesh.element_count();
    info.threads = options_.threads;
    info.wall_seconds = seconds_since(start_);
    info.resumed_at = resumed_at_;
    info.memory_bytes = peak_memory();
    info.passes = model_->passes();
    info.plan = plan_.sentences;
    info.warnings = warnings_;
    writer_.write_run_info(info);
  }

  Case<Dim> case_;
  const Plan& plan_;
  const SolverOptions& options_;
  const RunOptions& run_;
  std::string how_to_go_on_;
  std::string case_digest_;
  std::string folder_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_kept_ = start_;  ///< when a snapshot or a checkpoint was written
  std::unique_ptr<TwoPhaseModel<Dim>> model_;
  Progress progress_;
  OutputSchedule schedule_;
  std::optional<double> resumed_at_;  ///< s
  bool speed_warned_ = false;
  bool momentum_warned_ = false;
  bool compression_warned_ = false;
  std::vector<std::string> warnings_;
  ResultsWriter<Dim> writer_;
};

/// What the run in `folder` can go on from. Throws InputError where it is a run of something else.
template <int Dim>
FoundRestart find_restart(const Case<Dim>& c, const std::string& folder,
                          const SolverOptions& options) {
  const bool has_liquid = c.document.scene.formulation == Formulation::double_point;
  FoundRestart found = newest_restart_point(folder, has_liquid, c.mesh.region_names.size());
  if (!found.point) return found;
  const auto refuse = [&](const std::string& what, const std::string& how) {
    throw InputError(folder + ": cannot be resumed: it holds the results of " + what + "; " + how +
                     ", choose another folder with -o, or run anew without --resume");
  };
  if (found.point->case_digest != digest_of(c)) {
    refuse("another case (scene, mesh or points have changed since)",
           "take the case it began with");
  }
  if (found.point->no_skip != options.no_skip) {
    refuse(found.point->no_skip ? "a run with --no-skip" : "a run without --no-skip",
           "take the same option");
  }
  return found;
}

/// Where the run in `folder` stands. Nothing where it is done.
template <int Dim>
std::optional<StartingPoint> find_starting_point(const Case<Dim>& c, const std::string& folder,
                                                 const SolverOptions& options) {
  check_results_folder(folder, c.document.scene.name);
  if (is_finished(folder)) {
    // Looked at without the lock: it may be kept where nothing can be written.
    const FoundRestart found = find_restart(c, folder, options);
    const long all = OutputSchedule(c.document.scene).snapshots().count();
    if (found.point && found.point->snapshots == all && found.damage.empty()) return std::nullopt;
  }
  StartingPoint starting_point{folder, std::nullopt, FolderLock(folder)};
  FoundRestart found = find_restart(c, folder, options);
  for (const std::string& damage : found.damage) {
    std::fprintf(stderr, "suffuse-solver: warning: passed over: %s\n", damage.c_str());
  }
  if (!found.point && found.holds_results) {
    throw FileError(folder +
                    ": cannot be resumed: no snapshot there has a state to go on from; choose "
                    "another folder with -o, or run anew without --resume");
  }
  starting_point.from = std::move(found.point);
  return starting_point;
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
    starting_point =
        StartingPoint{folder, std::nullopt, lock_for_results(folder, c.document.scene.name)};
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
  const std::string how_to_go_on = "suffuse-solver " + quoted(case_path) + " -o " + quoted(folder) +
                                   (options.no_skip ? " --no-skip" : "") + " --resume";
  return static_cast<int>(
      Run<Dim>(std::move(c), plan, options, std::move(*starting_point), run, how_to_go_on).run());
}

template int run_case(Case<2>, const Plan&, const SolverOptions&, const std::string&,
                      const RunOptions&, const std::string&);

}  // namespace suffuse
