#include "driver/estimate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>

#include "case/errors.hpp"
#include "case/scratch_folder.hpp"
#include "driver/interrupt.hpp"
#include "driver/memory.hpp"
#include "driver/step_loop.hpp"
#include "formulation/double_point.hpp"
#include "formulation/single_point.hpp"
#include "physics/drag.hpp"
#include "results/layout.hpp"
#include "results/number_text.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Bytes and seconds of what a run writes.
struct Writing {
  double fixed = 0.0;             ///< bytes of what is written once, and of the tables' first lines
  double row = 0.0;               ///< bytes of one row of every table
  double snapshot = 0.0;          ///< bytes of the files of one snapshot but for liquid points
  double liquid = 0.0;            ///< bytes of its file of liquid points
  double state = 0.0;             ///< bytes of what a run can go on from
  double series = 0.0;            ///< bytes that it adds to the .series files
  double fixed_seconds = 0.0;     ///< wall time
  double row_seconds = 0.0;       ///< of one row of every table
  double snapshot_seconds = 0.0;  ///< of one snapshot
};

/// One row of every table and the snapshot that goes with it.
struct Output {
  HistoryRow history;
  LedgerRow ledger;
  std::vector<RegionRow> regions;
  Snapshot snapshot;
};

template <int Dim>
class TrialWriter {
 public:
  TrialWriter(const Case<Dim>& c, const Plan& plan) : plan_(plan) {
    const Stopwatch watch;
    writer_.emplace(folder_.path().string(), c);
    writing_.fixed_seconds = watch.seconds();
  }

  /// The latest that is written counts.
  void write(const Output& output) {
    const double before = sizes(fs::path(), tables);
    const double series_before = sizes(fs::path(), all_series);
    ++count_;
    Stopwatch rows;
    writer_->append_history(output.history);
    writer_->append_ledger(output.ledger);
    writer_->append_regions(output.regions);
    writing_.row_seconds = rows.seconds();
    Stopwatch snapshots;
    writer_->write_snapshot(output.snapshot);
    writing_.snapshot_seconds = snapshots.seconds();
    writing_.row = sizes(fs::path(), tables) - before;
    if (count_ > 1) writing_.series = sizes(fs::path(), all_series) - series_before;
    const std::string last = "000000";
    const std::string index = std::to_string(count_ - 1);
    const std::string number = last.substr(0, last.size() - index.size()) + index + ".hdf";
    // By itself it is about as large as in the file of a snapshot.
    writer_->write_checkpoint(*output.snapshot.restart);
    writing_.state = sizes(fs::path(), {layout::checkpoint});
    writing_.snapshot =
        sizes(layout::snapshots, {"mesh_" + number, "solid_" + number}) - writing_.state;
    writing_.liquid = sizes(layout::snapshots, {"liquid_" + number});
  }

  /// With what is written once.
  Writing finish() {
    RunInfo info;
    info.plan = plan_.sentences;
    writer_->write_run_info(info);
    writing_.fixed = sizes(fs::path(), {layout::run_info, layout::case_copy}) +
                     sizes(fs::path(), tables) - count_ * writing_.row;
    return writing_;
  }

 private:
  using Names = std::vector<std::string>;

  [[nodiscard]] double sizes(const fs::path& in, const Names& names) const {
    double sum = 0.0;
    for (const std::string& name : names) {
      std::error_code missing;
      const auto size = fs::file_size(folder_.path() / in / name, missing);
      if (!missing) sum += static_cast<double>(size);
    }
    return sum;
  }

  inline static const Names tables{layout::history, layout::ledger, layout::regions};
  inline static const Names all_series{layout::series("mesh"), layout::series("solid"),
                                       layout::series("liquid")};
  const Plan& plan_;
  ScratchFolder folder_{"suffuse-estimate"};
  std::optional<ResultsWriter<Dim>> writer_;
  Writing writing_;
  int count_ = 0;
};

/// How far the trial was after an interval, and what that interval took.
struct Interval {
  double time;  ///< simulated, at its end, s
  double step;  ///< length of its last step, s
  double steps;
  double looks;    ///< times of output in it
  double seconds;  ///< of wall time, but for making the outputs
};

/// Steps from `time` to `end`, when steps go on growing as they did until they are `longest`.
double steps_to_go(const std::vector<Interval>& latter, double longest, double end) {
  const Interval& last = latter.back();
  double left = end - last.time;
  double passed = 0.0;
  double steps = 0.0;
  for (std::size_t i = 1; i < latter.size(); ++i) {
    passed += latter[i].time - latter[i - 1].time;
    steps += latter[i].steps;
  }
  // With one interval alone there is nothing to see of growth.
  if (latter.size() < 2) return std::max(1.0, left / last.step);
  constexpr double noticeable = 1.05;
  const double growth =
      std::pow(last.step / latter.front().step, 1.0 / static_cast<double>(latter.size() - 1));
  if (growth < noticeable) return left * steps / passed;
  double count = 0.0;
  double step = last.step;
  while (left > 0.0 && step < longest) {
    step = std::min(growth * step, longest);
    left -= step;
    ++count;
  }
  return count + std::max(0.0, left / step);
}

/// Wall time of a step and of a look, from intervals with different numbers of either: least
/// squares. Where their numbers do not tell them apart looks are part of steps.
struct Costs {
  double step = 0.0;
  double look = 0.0;
};
Costs costs(const std::vector<Interval>& intervals) {
  double ss = 0.0;
  double sl = 0.0;
  double ll = 0.0;
  double ts = 0.0;
  double tl = 0.0;
  double steps = 0.0;
  double seconds = 0.0;
  for (const Interval& i : intervals) {
    ss += i.steps * i.steps;
    sl += i.steps * i.looks;
    ll += i.looks * i.looks;
    ts += i.seconds * i.steps;
    tl += i.seconds * i.looks;
    steps += i.steps;
    seconds += i.seconds;
  }
  constexpr double told_apart = 1e-3;
  const double determinant = ss * ll - sl * sl;
  if (determinant > told_apart * ss * ll) {
    const Costs result{(ts * ll - tl * sl) / determinant, (tl * ss - ts * sl) / determinant};
    if (result.step > 0.0 && result.look >= 0.0) return result;
  }
  return {seconds / steps, 0.0};
}

template <int Dim>
double pore_volume(const RigidSkeleton<Dim>& skeleton, const std::vector<double>& porosity) {
  double sum = 0.0;
  for (const ElementValues<Dim>& pores : skeleton.initial_pore_volume()) {
    sum += element_sum<Dim>(pores);
  }
  const MaterialPoints<Dim>& points = skeleton.points();
  for (int p = 0; p < points.size(); ++p) {
    sum += points.volume[p] * (porosity[p] - skeleton.initial_porosity()[p]);
  }
  return sum;
}

/// One trial of a formulation, SinglePoint or DoublePoint.
template <template <int> class Model, int Dim>
class Trial {
 public:
  Trial(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget)
      : case_(c), plan_(plan), budget_(budget), memory_before_(peak_memory()) {}

  Estimate run() {
    const Stopwatch watch;
    Model<Dim> model(case_, plan_);
    setup_seconds_ = watch.seconds();
    std::optional<TrialWriter<Dim>> writer;
    std::optional<Writing> writing;
    try {
      writer.emplace(case_, plan_);
      writer->write(look_at(model));
    } catch (const FileError&) {
      writer.reset();
    }
    StepLoop<Model<Dim>> loop(case_.document.scene, model);
    Estimate result;
    try {
      go(model, loop);
    } catch (const NumericalError& error) {
      result.failure = error.what();
    }
    try {
      if (writer) {
        writer->write(look_at(model));
        writing = writer->finish();
      }
    } catch (const FileError&) {
      writing.reset();
    }
    result.whole = loop.finished();
    result.over_budget = intervals_.size() == 1 && !result.whole && budget_.share >= 1.0;
    result.trial_steps = model.steps();
    result.trial_time = model.time();
    result.trial_seconds = watch.seconds();
    conclude(model, loop.schedule(), writing, result);
    return result;
  }

  /// What it took to set the flow in motion and will take until `settled`, s, and then until steps
  /// are `longest`.
  struct StartUp {
    double steps = 0.0;
    double seconds = 0.0;
  };
  [[nodiscard]] StartUp start_up(double settled, double longest) const {
    StartUp result;
    for (const Interval& i : intervals_) {
      result.steps += i.steps;
      result.seconds += i.seconds;
    }
    // Settling goes slower and slower: each doubling of the time takes as many steps as the last.
    const std::vector<Interval> latter = latter_part();
    double steps_in_latter = 0.0;
    for (const Interval& i : latter) steps_in_latter += i.steps;
    const double doublings = std::log2(std::max(1.0, settled / latter.back().time));
    const double more = doublings * steps_in_latter +
                        std::log2(std::max(1.0, longest / latter.back().step)) - doublings;
    result.steps += std::max(0.0, more);
    result.seconds += std::max(0.0, more) * costs(latter).step;
    return result;
  }
  [[nodiscard]] double longest_step() const {
    double longest = 0.0;
    for (const Interval& i : intervals_) longest = std::max(longest, i.step);
    return longest;
  }

 private:
  using State = typename Model<Dim>::State;

  static Output look_at(Model<Dim>& model) {
    const FlowState<Dim> moment = model.moment();
    Output output{model.history_row(model.state(), moment), model.ledger(model.state()),
                  model.region_rows(model.state()),
                  model.snapshot(model.state(), moment, model.steps())};
    StateArchive archive;
    archive(model);
    output.snapshot.restart = RestartPoint{};
    output.snapshot.restart->state = archive.finish();
    return output;
  }

  void go(Model<Dim>& model, StepLoop<Model<Dim>>& loop) {
    double looking = 0.0;
    const auto look = [&](const auto& looks) {
      const long before = snapshots_;
      for (const auto& [state, moment, due] : looks) {
        if (due.row) {
          const Stopwatch watch;
          (void)model.history_row(state, moment);
          (void)model.ledger(state);
          (void)model.region_rows(state);
          looking += watch.seconds();
          row_seconds_ += watch.seconds();
        }
        if (due.snapshot) {
          const Stopwatch watch;
          (void)model.snapshot(state, moment, model.steps());
          ++snapshots_;
          looking += watch.seconds();
          snapshot_seconds_ += watch.seconds();
        }
      }
      // Of several in an interval the last keeps the state.
      if (snapshots_ > before) ++states_;
    };
    const Stopwatch all;
    const double until = budget_.share * case_.document.scene.time.end;
    loop.start(look);
    while (!loop.finished() && !interrupted()) {
      const Stopwatch watch;
      looking = 0.0;
      const long steps = model.steps();
      const long looks = loop.advance(look);
      (void)model.take_warnings();
      intervals_.push_back({model.time(), model.last_step(),
                            static_cast<double>(model.steps() - steps), static_cast<double>(looks),
                            watch.seconds() - looking});
      if (all.seconds() >= budget_.seconds || model.time() >= until) break;
    }
  }

  /// What came after half of the time: the start of a flow is like nothing that comes later.
  [[nodiscard]] std::vector<Interval> latter_part() const {
    const double half = 0.5 * intervals_.back().time;
    auto from = std::find_if(intervals_.begin(), intervals_.end(),
                             [half](const Interval& i) { return i.time > half; });
    const std::ptrdiff_t few = std::min<std::ptrdiff_t>(2, std::ssize(intervals_));
    if (intervals_.end() - from < few) from = intervals_.end() - few;
    return {from, intervals_.end()};
  }

  void conclude(const Model<Dim>& model, const OutputSchedule& schedule,
                const std::optional<Writing>& writing, Estimate& result) const {
    result.rows = schedule.rows().count();
    result.snapshots = schedule.snapshots().count();
    result.steps = static_cast<double>(model.steps());
    result.seconds = setup_seconds_ + row_seconds_ + snapshot_seconds_;
    for (const Interval& i : intervals_) result.seconds += i.seconds;
    result.memory = peak_memory();

    const auto points = static_cast<double>(model.liquid_points());
    double more_points = 0.0;  // at the end, as a share of those there are
    if (!result.whole && result.failure.empty() && !intervals_.empty()) {
      const std::vector<Interval> latter = latter_part();
      const double steps = std::max(1.0, std::round(steps_to_go(latter, model.longest_interval(),
                                                                case_.document.scene.time.end)));
      const Costs cost = costs(latter);
      const auto rows_left = static_cast<double>(result.rows - schedule.rows().past());
      const auto snapshots_left =
          static_cast<double>(result.snapshots - schedule.snapshots().past());
      result.steps += steps;
      result.seconds +=
          steps * cost.step + std::max(rows_left, snapshots_left) * cost.look +
          rows_left * row_seconds_ / static_cast<double>(schedule.rows().past()) +
          snapshots_left * snapshot_seconds_ / static_cast<double>(schedule.snapshots().past());
      if (points > 0.0) more_points = growth_of_pores(model);
    }
    result.memory += more_points * (result.memory - memory_before_);
    if (!writing) {
      result.disk = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    const auto rows = static_cast<double>(result.rows);
    const auto snapshots = static_cast<double>(result.snapshots);
    const double liquid = writing->liquid * (1.0 + 0.5 * more_points);
    const double states =
        snapshots_ > 0 ? snapshots * static_cast<double>(states_) / static_cast<double>(snapshots_)
                       : snapshots;
    result.disk = writing->fixed + rows * writing->row + states * writing->state +
                  snapshots * (writing->snapshot + liquid + writing->series);
    result.seconds += writing->fixed_seconds + rows * writing->row_seconds +
                      snapshots * writing->snapshot_seconds;
  }

  /// By how much pores grow from now to the end, at most: liquid points fill them, each as large
  /// as it came in.
  [[nodiscard]] double growth_of_pores(const Model<Dim>& model) const {
    const Grid<Dim> grid(case_.mesh);
    const RigidSkeleton<Dim> skeleton(case_, grid);
    const State& state = model.state();
    const std::vector<double> last = skeleton.porosity_after(
        state.porosity, state.time, case_.document.scene.time.end,
        std::vector<double>(skeleton.points().size(), std::numeric_limits<double>::infinity()));
    return pore_volume(skeleton, last) / pore_volume(skeleton, state.porosity) - 1.0;
  }

  const Case<Dim>& case_;
  const Plan& plan_;
  TrialBudget budget_;
  double memory_before_;
  double setup_seconds_ = 0.0;
  double row_seconds_ = 0.0;
  double snapshot_seconds_ = 0.0;
  long snapshots_ = 0;
  long states_ = 0;  ///< how many of them keep the state of the run
  std::vector<Interval> intervals_;
};

/// Time after which an implicit flow from rest is steady to about 1e-5 of itself: the slowest
/// soil's pressures have spread over the whole model, and drag has stopped the liquid, s. Zero
/// where the start is not followed by steps that the scheme chooses.
template <int Dim>
double settling_time(const Case<Dim>& c) {
  const Scene& scene = c.document.scene;
  if (scene.time.scheme != FlowScheme::implicit_mixed ||
      scene.initial_flow == InitialFlow::steady) {
    return 0.0;
  }
  constexpr double folds = 11.0;  // of exp: 2e-5
  constexpr double pi = 3.14159265358979;
  Vector<Dim> low = c.mesh.nodes.front();
  Vector<Dim> high = low;
  for (const Vector<Dim>& x : c.mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double length = (high - low).maxCoeff();
  const double weight = scene.liquid.density * conductivity_gravity;
  double longest = 0.0;
  for (const Soil& soil : scene.soils) {
    const double diffusivity =
        scene.liquid.bulk_modulus * soil.conductivity / (weight * soil.porosity);
    const double spread = 4.0 * length * length / (pi * pi * diffusivity);
    const double relaxation = soil.conductivity / (soil.porosity * conductivity_gravity);
    longest = std::max(longest, folds * (spread + relaxation));
  }
  return longest;
}

template <template <int> class Model, int Dim>
Estimate estimate_formulation(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget) {
  Trial<Model, Dim> trial(c, plan, budget);
  Estimate first = trial.run();
  const Scene& scene = c.document.scene;
  const double settled = settling_time(c);
  if (first.whole || !first.failure.empty() || interrupted() || plan.flow.step_given ||
      first.trial_time > 2.0 * settled) {
    return first;
  }
  // The flow is still starting up, in steps that tell nothing of what comes later. A second trial
  // begins where that is over.
  Case<Dim> steady = c;
  steady.document.scene.initial_flow = InitialFlow::steady;
  const TrialBudget to_the_end{budget.seconds, 1.0};
  Trial<Model, Dim> later(steady, plan, to_the_end);
  Estimate result = later.run();
  if (!result.failure.empty()) return first;
  const auto start_up = trial.start_up(std::min(settled, scene.time.end), later.longest_step());
  result.steps = std::round(result.steps + start_up.steps);
  result.seconds += start_up.seconds;
  result.steady_steps = result.trial_steps;
  result.trial_steps = first.trial_steps;
  result.trial_time = first.trial_time;
  result.trial_seconds += first.trial_seconds;
  result.whole = false;
  return result;
}

/// Two or three digits.
std::string rounded(double value) {
  const double size = value > 0.0 ? std::pow(10.0, std::floor(std::log10(value)) - 1.0) : 1.0;
  std::ostringstream text;
  text.precision(10);
  text << std::round(value / size) * size;
  return text.str();
}

std::string duration_text(double seconds) {
  if (seconds < 120.0) return rounded(seconds) + " s";
  if (seconds < 7200.0) return rounded(seconds / 60.0) + " min";
  return rounded(seconds / 3600.0) + " h";
}

std::string counted(long count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

template <int Dim>
Estimate estimate_run(const Case<Dim>& c, const Plan& plan, const TrialBudget& budget) {
  if (c.document.scene.formulation == Formulation::single_point) {
    return estimate_formulation<SinglePoint, Dim>(c, plan, budget);
  }
  return estimate_formulation<DoublePoint, Dim>(c, plan, budget);
}

std::string bytes_text(double bytes) {
  for (const auto& [unit, name] : {std::pair(1e9, " GB"), std::pair(1e6, " MB")}) {
    if (bytes >= unit) return rounded(bytes / unit) + name;
  }
  return rounded(bytes / 1e3) + " kB";
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
  if (!e.failure.empty()) result.push_back("the run will fail: " + e.failure);
  return result;
}

template Estimate estimate_run(const Case<2>&, const Plan&, const TrialBudget&);

}  // namespace suffuse
