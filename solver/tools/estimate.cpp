#include "tools/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "common/deadline.hpp"
#include "common/errors.hpp"
#include "common/scratch_folder.hpp"
#include "driver/interrupt.hpp"
#include "driver/memory.hpp"
#include "driver/row_checks.hpp"
#include "driver/run_loop.hpp"
#include "driver/stopwatch.hpp"
#include "driver/transport_cost.hpp"
#include "files/layout.hpp"
#include "files/number_text.hpp"
#include "results/writer.hpp"
#include "tools/pilot.hpp"
#include "tools/trial_course.hpp"

namespace suffuse {
namespace {

/// Wall time above which a step is expensive, s.
constexpr double expensive_step = 0.1;
/// Fewest steps with a tolerance from which others can be estimated.
constexpr long fewest_steps = 3;

double size_of(const std::string& path) {
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  return none ? 0.0 : static_cast<double>(size);
}

/// Writes some snapshots of a trial into a temporary folder, because the size of compressed
/// snapshots changes during a run.
template <int Dim>
class WrittenSnapshots {
 public:
  explicit WrittenSnapshots(const Case<Dim>& c)
      : folder_("suffuse-estimate"), writer_(folder_.path().string(), c) {}

  [[nodiscard]] ResultsWriter<Dim>& writer() { return writer_; }
  /// Size of all files except snapshots, bytes.
  [[nodiscard]] double size_without_snapshots() const {
    double sum = 0.0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      const bool is_snapshot = name.find("_0") != std::string::npos;
      if (entry.is_regular_file() && !is_snapshot) sum += size_of(entry.path().string());
    }
    return sum;
  }
  /// Size of the state of a run, bytes.
  [[nodiscard]] double state_size() const { return state_size_; }
  [[nodiscard]] double seconds() const { return seconds_; }

  /// Writes snapshot `index` of the run. Snapshots in between are left out.
  void write(long index, Snapshot snapshot) {
    const Stopwatch watch;
    writer_.write_snapshot(std::move(snapshot));
    // The first snapshot takes longer than the others, so the mean leaves it out.
    const auto followers = static_cast<double>(std::max<std::size_t>(samples_.size(), 1));
    const double before = samples_.size() > 1 ? seconds_ : 0.0;
    seconds_ = before + (watch.seconds() - before) / followers;
    double bytes = 0.0;
    for (const char* kind : {"mesh", "solid", "liquid"}) {
      bytes += size_of(path_of(layout::snapshot(kind, samples_.size())));
    }
    state_size_ = size_of(path_of(layout::state(samples_.size())));
    samples_.emplace_back(index, bytes);
  }
  /// Index of the last snapshot that was written; -1 before the first.
  [[nodiscard]] long last() const { return samples_.empty() ? -1 : samples_.back().first; }

  /// Size of all `count` snapshots, bytes: interpolated linearly, later ones like the last.
  [[nodiscard]] double bytes_of_all(long count) const {
    double sum = samples_.front().second;
    for (std::size_t k = 1; k < samples_.size(); ++k) {
      const auto& [from, from_bytes] = samples_[k - 1];
      const auto& [to, to_bytes] = samples_[k];
      const auto gap = static_cast<double>(to - from);
      sum += gap * from_bytes + 0.5 * (gap + 1.0) * (to_bytes - from_bytes);
    }
    return sum + static_cast<double>(count - 1 - last()) * samples_.back().second;
  }

 private:
  [[nodiscard]] std::string path_of(const std::string& name) const {
    return layout::in_folder(folder_.path().string(), name);
  }

  ScratchFolder folder_;
  ResultsWriter<Dim> writer_;
  std::vector<std::pair<long, double>> samples_;  ///< number in the run, bytes
  double state_size_ = 0.0;
  double seconds_ = 0.0;  ///< of one snapshot
};

/// A run that writes a few snapshots only and may end early.
template <int Dim>
class Trial final : public OutputSink<Dim> {
 public:
  Trial(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget,
        const EarlierState<Dim>* earlier)
      : case_(c),
        plan_(plan),
        budget_(budget),
        deadline_(budget.patience),
        loop_(c, plan, earlier),
        checks_(c.document.scene, plan.row_limits) {
    try {
      files_.emplace(c);
    } catch (const FileError&) {
      // The size of the files stays unknown.
    }
  }

  /// Throws DeadlinePassed if no step has ended.
  Estimate run() {
    Estimate result;
    course_.marks = {{0.0, 0.0, seconds()}};
    bool complete = true;
    try {
      loop_.run(*this);
    } catch (const NumericalError& error) {
      result.failure = error.what();
    } catch (const DeadlinePassed&) {
      if (course_.marks.size() < 2) throw;
      result.too_short = is_adaptive() && course_.marks.size() <= fewest_steps;
      complete = false;  // the state of the model must not be used any more
    }
    deadline_.reset();
    result.memory = peak_memory();
    result.whole = loop_.finished();
    result.over_budget = course_.marks.size() == 2 && !result.whole && budget_.share >= 1.0;
    result.trial_steps = std::lround(course_.last().steps);
    result.trial_time = course_.last().time;
    double seconds_of_files = 0.0;
    if (complete) {
      seconds_of_files = add_files(result);
      describe(result);
    } else {
      add_written_files(result);
    }
    if (complete && !result.whole && result.failure.empty() && !interrupted()) look_ahead(result);
    result.steps = course_.last().steps;
    result.seconds = course_.last().seconds;
    if (!result.whole && result.failure.empty() && result.trial_steps > 0) extrapolate(result);
    result.steps = std::round(result.steps);
    // Snapshots are written while the run continues.
    if (files_) {
      result.seconds =
          std::max(result.seconds, static_cast<double>(result.snapshots) * files_->seconds());
    }
    result.seconds += seconds_of_files;
    result.trial_seconds = watch_.seconds();
    return result;
  }

  void warn(const std::string& /*text*/) override {}
  void write_row(const FlowState<Dim>& flow) override {
    checks_.check(loop_.model().history_row(flow));
  }
  void write_snapshot(const FlowState<Dim>& flow) override {
    constexpr long samples = 16;
    const OutputTimes& times = loop_.schedule().snapshots();
    const long index = times.past() - 1;
    if (index % (times.count() / samples + 1) == 0) write_sample(index, flow);
  }
  bool continue_after_interval() override {
    const double time = loop_.model().time();
    course_.marks.push_back({time, static_cast<double>(loop_.model().steps()), seconds()});
    return course_.last().seconds - course_.marks.front().seconds < budget_.seconds &&
           time < budget_.share * case_.document.scene.time.end;
  }

 private:
  /// Adds the sentences about transport.
  void describe(Estimate& result) const {
    const Scene& scene = case_.document.scene;
    const bool has_a_choice = scene.formulation == Formulation::single_point &&
                              scene.time.scheme == FlowScheme::implicit_mixed;
    if (has_a_choice) result.transport = transport_sentence(loop_.model(), scene.time.end);
    if (const auto text = many_crossings_warning(loop_.model(), scene.time.end)) {
      result.warning = *text;
    }
  }

  /// Whether steps keep a tolerance, so that their length changes during the run.
  [[nodiscard]] bool is_adaptive() const {
    return case_.document.scene.time.scheme == FlowScheme::implicit_mixed && !plan_.flow.step_given;
  }

  void look_ahead(Estimate& result) {
    if (!is_adaptive() || course_.marks.size() < 2) return;
    const double each = course_.mean_seconds();
    const double wanted = each > expensive_step ? budget_.ahead_if_expensive : budget_.ahead;
    Pilot<Dim> pilot(case_, plan_, loop_.model());
    pilot.look_ahead(std::min(wanted, budget_.patience - watch_.seconds()), each, course_);
    result.pilot_steps = pilot.steps();
    result.pilot_time = course_.last().time;
    result.too_short = result.trial_steps + result.pilot_steps < fewest_steps;
  }

  void extrapolate(Estimate& result) const {
    const Scene& scene = case_.document.scene;
    if (course_.last().time >= scene.time.end) return;
    const double longest = std::min(scene.output.every, scene.output.snapshot_every);
    // The flow changes abruptly at breakpoints of its boundaries, each of which costs steps.
    const auto& kinks = loop_.model().flow().boundary_values().breakpoints();
    const auto passed = std::ranges::upper_bound(kinks, course_.last().time) - kinks.begin();
    const double of_each = course_.last().steps / static_cast<double>(passed + 1);
    const double by_kinks =
        is_adaptive() ? static_cast<double>(std::ssize(kinks) - passed) * of_each : 0.0;
    const double by_time = std::max(1.0, course_.steps_to_go(longest, scene.time.end));
    result.steps += std::max(by_kinks, by_time);
    result.seconds += by_kinks > by_time ? by_kinks * course_.mean_seconds()
                                         : by_time * course_.seconds_per_step();
  }

  /// Time spent on computing, s.
  [[nodiscard]] double seconds() const { return watch_.seconds() - seconds_of_writing_; }

  void write_sample(long index, const FlowState<Dim>& flow) {
    // Outputs while soil fails come between those that are counted.
    if (!files_ || index <= files_->last()) return;
    const Stopwatch watch;
    try {
      Snapshot snapshot = loop_.model().snapshot(flow);
      snapshot.restart = loop_.restart_point();
      files_->write(index, std::move(snapshot));
    } catch (const FileError&) {
      files_.reset();
    }
    seconds_of_writing_ += watch.seconds();
  }

  /// Adds the size of the run's files, with rows like that of the last state. Returns the time to
  /// write the tables, s.
  double add_files(Estimate& result) {
    const OutputTimes& times = loop_.schedule().snapshots();
    result.snapshots = times.count();
    const FlowState<Dim> flow = loop_.model().flow_state();
    if (files_ && files_->last() < result.snapshots - 1) {
      write_sample(std::max(files_->last() + 1, times.past() - 1), flow);
    }
    if (!files_) return 0.0;
    const long kept = std::min<long>(result.snapshots, case_.document.scene.output.restarts);
    double seconds = 0.0;
    try {
      result.disk = files_->bytes_of_all(result.snapshots) +
                    static_cast<double>(kept) * files_->state_size() + add_rows(seconds, flow);
    } catch (const FileError&) {
    }
    return seconds;
  }

  /// Adds the size of the run's files from those written, if the last state is incomplete.
  void add_written_files(Estimate& result) {
    result.snapshots = loop_.schedule().snapshots().count();
    if (!files_ || files_->last() < 0) return;
    const long kept = std::min<long>(result.snapshots, case_.document.scene.output.restarts);
    result.disk = files_->bytes_of_all(result.snapshots) + files_->size_without_snapshots() +
                  static_cast<double>(kept) * files_->state_size();
  }

  /// Size of all files except snapshots, with all rows, bytes. Sets `seconds` to the time to write
  /// the rows. Throws FileError.
  double add_rows(double& seconds, const FlowState<Dim>& flow) {
    const auto rows = static_cast<double>(loop_.schedule().rows().count());
    const auto write = [&] { OutputRows(loop_.model(), flow).append_to(files_->writer()); };
    const double others = files_->size_without_snapshots();
    write();  // not timed, because the first row takes longer
    const double before = files_->size_without_snapshots();
    const Stopwatch watch;
    write();
    seconds = rows * watch.seconds();
    return others + rows * (files_->size_without_snapshots() - before);
  }

  const Case<Dim>& case_;
  const Plan& plan_;
  TrialBudget budget_;
  Stopwatch watch_;
  std::optional<Deadline> deadline_;  ///< for the model's start and its steps
  RunLoop<Dim> loop_;
  RowChecks checks_;
  TrialCourse course_;
  std::optional<WrittenSnapshots<Dim>> files_;  ///< nothing if they cannot be written
  double seconds_of_writing_ = 0.0;
};

std::string counted(long count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

template <int Dim>
Estimate estimate_run(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget,
                      const EarlierState<Dim>* earlier) {
  const Stopwatch watch;
  try {
    return Trial<Dim>(c, plan, budget, earlier).run();
  } catch (const DeadlinePassed&) {
    Estimate nothing;
    nothing.too_short = true;
    nothing.memory = peak_memory();
    nothing.trial_seconds = watch.seconds();
    return nothing;
  }
}

std::vector<std::string> sentences(const Estimate& e, int threads) {
  if (e.too_short) {
    return {"estimate: none, as " +
            (e.trial_steps == 0 ? "no step" : "only " + counted(e.trial_steps, "step")) +
            " ended within " + duration_text(e.trial_seconds) + "; " + bytes_text(e.memory) +
            " of memory so far"};
  }
  std::ostringstream what;
  what << "estimate: " << std::llround(e.steps) << " steps, " << duration_text(e.seconds) << " on "
       << counted(threads, "thread") << ", " << bytes_text(e.memory) << " of memory, ";
  const std::string files = counted(e.snapshots, "snapshot") + " and its tables";
  if (std::isnan(e.disk)) {
    what << files << " of unknown size (the folder for temporary files cannot be written)";
  } else {
    what << bytes_text(e.disk) << " in " << files;
  }
  std::ostringstream from;
  from << "estimate: from a trial of the ";
  if (e.whole) {
    from << "whole run without writing";
  } else {
    from << "first " << counted(e.trial_steps, "step") << " (t = " << short_text(e.trial_time)
         << " s) ";
    if (e.pilot_steps > 0) {
      from << "and of " << counted(e.pilot_steps, "long step")
           << " from there to t = " << short_text(e.pilot_time) << " s, ";
    }
    from << "in " << duration_text(e.trial_seconds);
    if (e.over_budget && e.pilot_steps == 0) {
      from << "; the case is too large for a longer one, so take it with care";
    }
  }
  std::vector<std::string> result{what.str(), from.str()};
  if (!e.transport.empty()) result.push_back(e.transport);
  if (!e.warning.empty()) result.push_back("warning: " + e.warning);
  if (!e.failure.empty()) result.push_back("the run will fail: " + e.failure);
  return result;
}

template Estimate estimate_run(const Case<2>&, const Plan&, const TrialBudget&,
                               const EarlierState<2>*);
template Estimate estimate_run(const Case<3>&, const Plan&, const TrialBudget&,
                               const EarlierState<3>*);

}  // namespace suffuse
