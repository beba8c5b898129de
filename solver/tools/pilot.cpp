#include "tools/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/deadline.hpp"
#include "common/errors.hpp"
#include "driver/interrupt.hpp"
#include "driver/stopwatch.hpp"
#include "results/state_archive.hpp"

namespace suffuse {
namespace {

/// Factor on the tolerance for the pilot's steps, which are about ten times longer then.
constexpr double looser = 100.0;
constexpr double loosest = 0.1;
/// If the pilot cannot reach the end in such steps, it continues with equal steps and this
/// tolerance, which does not shorten them.
constexpr double no_tolerance = 100.0;
constexpr double fewest_pilot_steps = 2.0;
constexpr double most_steps = 24.0;
/// Cost of such a step over that of one of the run's own steps.
constexpr double long_over_own = 8.0;
/// Limits of their growth per step, which reaches the final length after half of the steps.
constexpr double least_growth = 8.0;
constexpr double most_growth = 1000.0;
/// Fewest of them between two breakpoints of the boundary values.
constexpr double fewest_between_kinks = 3.0;
constexpr double hardly_growing = 1.2;
/// Additional own steps of the run after a breakpoint, where they start short and grow.
constexpr double steps_after_kink = 4.0;
/// Share of the time for the pilot, and share of that for its steps with a tolerance.
constexpr double share_of_pilot = 0.7;
constexpr double share_of_control = 0.45;
/// If time suffices for fewer of the run's own steps, steps with a tolerance are left out.
constexpr double worth_control = 40.0;
/// Most states that are kept.
constexpr std::size_t most_places = 16;
/// Steps tried at a place. The first are not counted, because they follow a long step.
constexpr int uncounted = 2;
constexpr int counted_steps = 3;

template <int Dim>
std::vector<std::uint8_t> state_of(TwoPhaseModel<Dim>& model) {
  StateArchive archive;
  archive(model);
  return archive.finish();
}

template <int Dim>
void restore(TwoPhaseModel<Dim>& model, std::vector<std::uint8_t> state) {
  StateArchive archive(std::move(state));
  archive(model);
  archive.finish();
}

}  // namespace

template <int Dim>
Pilot<Dim>::Pilot(const Case<Dim>& c, const ModelOptions& options, TwoPhaseModel<Dim>& model)
    : case_(c), options_(options), model_(model), time_(model.time()), state_(state_of(model)) {}

template <int Dim>
void Pilot<Dim>::look_ahead(double seconds, double each, TrialCourse& course) {
  const Stopwatch watch;
  const Scene& scene = case_.document.scene;
  double to_travel = share_of_pilot * seconds;
  if (to_travel > worth_control * each) {
    const double tolerance = std::min(loosest, looser * scene.time.tolerance);
    travel(std::max(tolerance, scene.time.tolerance), std::nullopt, share_of_control * to_travel);
    smooth_steps_ = steps_.size();
  }
  if (!has_arrived()) {
    const double dearer = std::max(each, watch.seconds() / static_cast<double>(steps_.size() + 1));
    const double affordable = (to_travel - watch.seconds()) / (long_over_own * dearer);
    if (affordable < fewest_pilot_steps) to_travel = seconds;
    const double count = std::clamp(affordable, fewest_pilot_steps, most_steps);
    travel(no_tolerance, count, to_travel - watch.seconds());
  }
  if (!interrupted()) try_steps(seconds - watch.seconds());
  double cost = course.seconds_per_step();
  auto place = places_.begin();
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    while (place != places_.end() && place->index < i) ++place;
    if (place != places_.end() && place->seconds > 0.0) {
      // Without a tolerance the state is inaccurate, and steps take longer than in the run.
      cost = i < smooth_steps_ ? place->seconds : std::sqrt(place->seconds * each);
    }
    const Mark& last = course.last();
    course.marks.push_back(
        {steps_[i].end, last.steps + steps_[i].count, last.seconds + steps_[i].count * cost});
  }
}

template <int Dim>
void Pilot<Dim>::travel(double tolerance, std::optional<double> count, double seconds) {
  const Deadline deadline(seconds);
  Case<Dim> changed = case_;
  Scene& scene = changed.document.scene;
  scene.initial_flow = InitialFlow::rest;  // `restore` replaces it; rest is the fastest start
  scene.time.tolerance = tolerance;
  try {
    const auto model = make_model(changed, options_);
    restore(*model, state_);
    double longest = 0.0;
    double growth = 0.0;
    if (count) {
      longest = (scene.time.end - time_) / *count;
      growth = std::clamp(std::pow(longest / model->last_step(), 2.0 / *count), least_growth,
                          most_growth);
    }
    const std::vector<double>& kinks = model->flow().boundary_values().breakpoints();
    while (!has_arrived() && !interrupted()) {
      const double start = time_;
      double latest = scene.time.end;
      if (count) {
        const auto next = std::ranges::upper_bound(kinks, start);
        const double from = next == kinks.begin() ? 0.0 : *std::prev(next);
        const double to = next == kinks.end() ? latest : *next;
        const double dt =
            std::min({longest, growth * model->last_step(), (to - from) / fewest_between_kinks});
        model->plan_step(dt);
        latest = std::min(latest, start + dt);
      }
      try {
        model->advance(latest);
      } catch (const NumericalError&) {
        // The step is too long; a shorter one may succeed.
        growth = std::sqrt(growth);
        if (!count || growth < hardly_growing) return;
        restore(*model, state_);
        continue;
      }
      note_step(*model, start);
    }
  } catch (const NumericalError&) {
    // The pilot cannot start.
  } catch (const DeadlinePassed&) {
    // The time is over.
  }
}

template <int Dim>
void Pilot<Dim>::note_step(TwoPhaseModel<Dim>& model, double start) {
  const Scene& scene = case_.document.scene;
  time_ = model.time();
  state_ = state_of(model);
  // Steps of the run are not longer than those of the pilot and the times between outputs.
  const double own = std::min({model.flow().step_within(scene.time.tolerance), time_ - start,
                               scene.output.every, scene.output.snapshot_every});
  if (steps_.size() % stride_ == 0) places_.push_back({steps_.size(), state_, own});
  const bool starts_at_kink =
      std::ranges::binary_search(model.flow().boundary_values().breakpoints(), start);
  steps_.push_back({time_, (time_ - start) / own + (starts_at_kink ? steps_after_kink : 0.0)});
  if (places_.size() <= most_places) return;
  for (std::size_t k = 1; 2 * k < places_.size(); ++k) places_[k] = std::move(places_[2 * k]);
  places_.resize((places_.size() + 1) / 2);
  stride_ *= 2;
}

template <int Dim>
void Pilot<Dim>::try_steps(double seconds) {
  const Deadline deadline(seconds);
  std::size_t width = 2;
  while (width < places_.size()) width *= 2;
  try {
    // The last place gives the cost of extrapolated steps.
    if (!places_.empty()) try_steps_at(places_.back());
    for (; width >= 2; width /= 2) {
      for (std::size_t k = width / 2; k < places_.size(); k += width) {
        try_steps_at(places_[k - 1]);
      }
    }
  } catch (const DeadlinePassed&) {
    // The time is over; other places have no measured cost.
  }
}

template <int Dim>
void Pilot<Dim>::try_steps_at(Place& place) {
  try {
    restore(model_, place.state);
    const double end = case_.document.scene.time.end;
    model_.plan_step(place.step);
    for (int k = 0; k < uncounted && model_.time() < end; ++k) model_.advance(end);
    const Stopwatch watch;
    const long before = model_.steps();
    for (int k = 0; k < counted_steps && model_.time() < end; ++k) model_.advance(end);
    const long taken = model_.steps() - before;
    if (taken > 0) place.seconds = watch.seconds() / static_cast<double>(taken);
  } catch (const NumericalError&) {
    // Other places may have a result.
  }
}

template class Pilot<2>;
template class Pilot<3>;

}  // namespace suffuse
