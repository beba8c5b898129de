#include "driver/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "case/errors.hpp"
#include "case/scratch_folder.hpp"
#include "driver/interrupt.hpp"
#include "driver/memory.hpp"
#include "driver/row_checks.hpp"
#include "driver/run_loop.hpp"
#include "driver/stopwatch.hpp"
#include "driver/transport_cost.hpp"
#include "driver/trial_course.hpp"
#include "results/number_text.hpp"
#include "results/writer.hpp"

namespace suffuse {
namespace {

double folder_size(const std::filesystem::path& folder) {
  double sum = 0.0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) sum += static_cast<double>(entry.file_size());
  }
  return sum;
}

/// A run that writes nothing and may end early.
template <int Dim>
class Trial final : public OutputSink<Dim> {
 public:
  Trial(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget)
      : case_(c),
        budget_(budget),
        loop_(c, plan),
        checks_(c.document.scene, plan.speed_that_drag_follows) {}

  Estimate run() {
    Estimate result;
    course_.marks = {{0.0, 0.0, watch_.seconds()}};
    try {
      loop_.run(*this);
    } catch (const NumericalError& error) {
      result.failure = error.what();
    }
    result.whole = loop_.finished();
    result.over_budget = course_.marks.size() == 2 && !result.whole && budget_.share >= 1.0;
    result.trial_steps = loop_.model().steps();
    result.trial_time = loop_.model().time();
    result.steps = static_cast<double>(result.trial_steps);
    result.seconds = course_.last().seconds;
    if (!result.whole && result.failure.empty() && result.trial_steps > 0) extrapolate(result);
    try {
      add_files(result);
    } catch (const FileError&) {
      // The size of the files remains unknown.
    }
    const Scene& scene = case_.document.scene;
    const bool has_a_choice = scene.formulation == Formulation::single_point &&
                              scene.time.scheme == FlowScheme::implicit_mixed;
    if (has_a_choice) result.transport = transport_sentence(loop_.model(), scene.time.end);
    if (const auto text = many_crossings_warning(loop_.model(), scene.time.end)) {
      result.warning = *text;
    }
    result.memory = peak_memory();
    result.trial_seconds = watch_.seconds();
    return result;
  }
  [[nodiscard]] const TrialCourse& course() const { return course_; }

  void warn(const std::string& /*text*/) override {}
  void write_row(const FlowState<Dim>& flow) override {
    checks_.check(loop_.model().history_row(flow));
  }
  void write_snapshot(const FlowState<Dim>& /*flow*/) override {}
  bool continue_after_interval() override {
    const double time = loop_.model().time();
    course_.marks.push_back({time, static_cast<double>(loop_.model().steps()), watch_.seconds()});
    return course_.last().seconds - course_.marks.front().seconds < budget_.seconds &&
           time < budget_.share * case_.document.scene.time.end;
  }

 private:
  void extrapolate(Estimate& result) const {
    const Scene& scene = case_.document.scene;
    const double longest = std::min(
        {loop_.model().coupling_interval(), scene.output.every, scene.output.snapshot_every});
    const double steps = std::max(1.0, course_.steps_to_go(longest, scene.time.end));
    result.steps = std::round(result.steps + steps);
    result.seconds += steps * course_.seconds_per_step();
  }

  /// The files of the run and the time to write them, as for the last state. Throws FileError.
  void add_files(Estimate& result) {
    const long rows = loop_.schedule().rows().count();
    result.snapshots = loop_.schedule().snapshots().count();
    const ScratchFolder folder("suffuse-estimate");
    ResultsWriter<Dim> writer(folder.path().string(), case_);
    const FlowState<Dim> flow = loop_.model().flow_state();
    double bytes = folder_size(folder.path());
    double seconds = 0.0;
    const auto add = [&](long count, const auto& write) {
      write();  // the first takes more time than those that follow
      const double before = folder_size(folder.path());
      const Stopwatch watch;
      write();
      seconds += static_cast<double>(count) * watch.seconds();
      bytes += static_cast<double>(count) * (folder_size(folder.path()) - before);
    };
    add(rows, [&] {
      writer.append_history(loop_.model().history_row(flow));
      append_tables(writer, loop_.model(), flow);
    });
    add(result.snapshots, [&] {
      Snapshot snapshot = loop_.model().snapshot(flow);
      snapshot.restart = loop_.restart_point();
      writer.write_snapshot(std::move(snapshot));
    });
    result.disk = bytes;
    result.seconds += seconds;
  }

  const Case<Dim>& case_;
  TrialBudget budget_;
  Stopwatch watch_;
  RunLoop<Dim> loop_;
  RowChecks checks_;
  TrialCourse course_;
};

std::string counted(long count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

template <int Dim>
Estimate estimate_run(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget) {
  Estimate first;
  TrialCourse start_up;
  {
    Trial<Dim> trial(c, plan, budget);
    first = trial.run();
    start_up = trial.course();
  }
  const Scene& scene = c.document.scene;
  const double settled = std::min(plan.settling_time, scene.time.end);
  const bool starts_up = scene.initial_flow == InitialFlow::rest && !plan.flow.step_given &&
                         first.trial_time <= 2.0 * settled;
  if (!starts_up || first.whole || !first.failure.empty() || interrupted()) return first;

  // The steps of a start-up tell nothing of those that come after it: a second trial starts there.
  Case<Dim> steady = c;
  steady.document.scene.initial_flow = InitialFlow::steady;
  Trial<Dim> later(steady, plan, {budget.seconds, 1.0});
  Estimate result = later.run();
  if (!result.failure.empty()) return first;
  const double longest = 1.0 / step_rate(later.course().half(), later.course().last());
  const double more = start_up.steps_to_go(longest, settled);
  result.steps = std::round(result.steps + start_up.last().steps + more);
  result.seconds += start_up.last().seconds + more * start_up.seconds_per_step();
  result.steady_steps = result.trial_steps;
  result.trial_steps = first.trial_steps;
  result.trial_time = first.trial_time;
  result.trial_seconds += first.trial_seconds;
  result.whole = false;
  return result;
}

std::vector<std::string> sentences(const Estimate& e, int threads) {
  std::ostringstream what;
  what << "estimate: " << std::llround(e.steps) << " steps, " << duration_text(e.seconds) << " on "
       << counted(threads, "thread") << ", " << bytes_text(e.memory) << " of memory, ";
  const std::string files = counted(e.snapshots, "snapshot") + " and 3 tables";
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
    if (e.steady_steps > 0) from << "and of " << e.steady_steps << " from the steady flow on, ";
    from << "in " << duration_text(e.trial_seconds);
    if (e.over_budget) from << "; the case is too large for a longer one, so take it with care";
  }
  std::vector<std::string> result{what.str(), from.str()};
  if (!e.transport.empty()) result.push_back(e.transport);
  if (!e.warning.empty()) result.push_back("warning: " + e.warning);
  if (!e.failure.empty()) result.push_back("the run will fail: " + e.failure);
  return result;
}

template Estimate estimate_run(const Case<2>&, const Plan&, const TrialBudget&);

}  // namespace suffuse
