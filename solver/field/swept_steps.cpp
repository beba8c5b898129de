#include "field/swept_steps.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/deadline.hpp"
#include "common/errors.hpp"

namespace suffuse {
namespace {

// Limits of the length of a step, relative to the step before.
constexpr double most_growth = 4.0;
constexpr double least = 0.1;
constexpr double most_retry = 0.9;
constexpr double unsolved = 0.25;
constexpr double safety = 0.85;
/// Fines that enter during this share of the run are negligible.
constexpr double passing_share = 1e-6;
/// A step is extended to the end if the rest is less than this share of the step.
constexpr double end_margin = 1e-9;

}  // namespace

template <int Dim>
void SweptSteps<Dim>::start(double start, const FlowProgress& flow) {
  const PassTimer timer(timing_);
  start_ = time_ = start;
  end_ = flow.end;
  field_.start(flow.volumes.liquid, flow.room_gained);
}

template <int Dim>
double SweptSteps<Dim>::relative(const StepErrors& errors, double dt) const {
  const double coming = (errors.exchanged + errors.entered) / dt;
  const double held = std::max({most_held_, errors.held, passing_share * settings_.end * coming});
  const double exchanged = std::max(held, exchanged_ + errors.exchanged);
  if (std::max(errors.fines, errors.exchange) <= round_off_) return 0.0;
  return std::max(errors.fines / held, errors.exchange / exchanged) / settings_.tolerance;
}

template <int Dim>
const std::vector<Exchange>& SweptSteps<Dim>::solve(const FinesState<Dim>& state,
                                                    const Skeleton<Dim>& solid,
                                                    const PointFlows& flows) {
  const PassTimer timer(timing_);
  const double left = end_ - time_;
  dt_ = settings_.step_is_given ? left : std::min(next_, left);
  // Divides the rest into two equal steps to avoid a short last one.
  if (dt_ < left && left < 2.0 * dt_) dt_ = 0.5 * left;
  const bool shortened = dt_ < next_;
  bool rejected = false;
  for (;;) {
    Deadline::check();
    ++timing_.calls;
    const bool to_end = dt_ * (1.0 + end_margin) >= left;
    const double to = to_end ? end_ : time_ + dt_;
    const SolidInStep<Dim> in_step{solid, flows, time_, to, solid.exchanges_within(time_, to)};
    const bool solved = field_.solve(state, in_step, (to - time_) / (end_ - start_), errors_);
    const double error = !solved || settings_.step_is_given ? 0.0 : relative(errors_, to - time_);
    const double wanted = !solved       ? unsolved
                          : error > 0.0 ? safety / std::sqrt(error)
                                        : most_growth;
    if (solved && error <= 1.0) {
      const double next = dt_ * std::clamp(wanted, least, most_growth);
      // A step that was shortened to the interval must not reduce the planned length.
      next_ = shortened && !rejected && wanted >= 1.0 ? std::max(next, next_) : next;
      dt_ = to - time_;
      return field_.exchange();
    }
    rejected = true;
    dt_ *= std::clamp(wanted, least, most_retry);
    if (dt_ > 1e-14 * time_ && dt_ > 0.0) continue;
    std::ostringstream message;
    message << "no step of implicit transport is short enough for time.tolerance = "
            << settings_.tolerance << " at t = " << time_
            << " s; take a larger tolerance or time.transport = \"explicit\"";
    throw NumericalError(message.str());
  }
}

template <int Dim>
void SweptSteps<Dim>::finish(FinesState<Dim>& state, const ElementField<Dim>& received) {
  const PassTimer timer(timing_);
  field_.finish(state, received);
  most_held_ = std::max(most_held_, errors_.held);
  exchanged_ += errors_.exchanged;
  time_ += dt_;
  if (end_ - time_ <= end_margin * dt_) time_ = end_;
}

template class SweptSteps<2>;
template class SweptSteps<3>;

}  // namespace suffuse
