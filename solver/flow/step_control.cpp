#include "flow/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/errors.hpp"
#include "grid/field_values.hpp"
#include "grid/parallel.hpp"
#include "mixed/implicit_thresholds.hpp"

namespace suffuse {
namespace {

/// Rounds a step that is short compared with its start to the difference of the two times, which
/// transport and the solid use.
double rounded(double start, double dt) {
  return dt < implicit_thresholds.rounded_step * start ? (start + dt) - start : dt;
}

}  // namespace

void StepControl::start(double first_step, bool smooth, double shortest_change) {
  next_ = settings_.given_step.value_or(first_step);
  smooth_ = smooth;
  shortest_change_ = shortest_change;
  pass_kink();
}

bool StepControl::is_jump(double start, double dt) const {
  const double unnoticed =
      std::min(implicit_thresholds.jump * settings_.end / settings_.tolerance, shortest_change_);
  const double unresolved =
      implicit_thresholds.unresolved_steps * implicit_thresholds.min_step_of_time * start;
  if (!(dt <= std::max(unnoticed, unresolved))) return false;
  const bool starts_at_kink = start == 0.0 || contains_time(settings_.kinks, start);
  return starts_at_kink && contains_time(settings_.kinks, start + dt);
}

double StepControl::propose(double start, double until, double longest) {
  shortened_ = false;
  rejected_dt_ = 0.0;
  const double left = until - start;
  if (settings_.given_step) {
    // The given step is the longest one: the remaining time is divided evenly.
    return left / std::max(1.0, std::ceil(left / *settings_.given_step *
                                          (1.0 - implicit_thresholds.end_margin)));
  }
  if (is_jump(start, left)) return left;
  double dt = std::min(next_, longest);
  planned_ = dt;
  if (dt < left) refuse_too_short(start, dt);
  // Avoid a short last step: take two halves, not nine tenths and one tenth.
  if (dt < left && left < 2.0 * dt) dt = is_too_short(start, 0.5 * left) ? left : 0.5 * left;
  return up_to(rounded(start, dt), left);
}

double StepControl::up_to(double dt, double left) {
  return dt * (1.0 + implicit_thresholds.end_margin) >= left ? left : dt;
}

double StepControl::error(double start, double dt,
                          const std::vector<ControlledField>& fields) const {
  const double share = error_share(start, dt);
  if (share == 0.0) return 0.0;
  double error = 0.0;
  for (const ControlledField& field : fields) {
    if (!(field.scale > 0.0)) continue;
    const bool predicts = !field.previous.empty();
    const double ahead = predicts ? dt / last_ : 0.0;
    const auto distance_at = [&](int i) {
      const double now = field.start[i];
      const double predicted = predicts ? now + ahead * (now - field.previous[i]) : now;
      return std::abs(field.end[i] - predicted);
    };
    const auto count = static_cast<int>(field.start.size());
    double distance = 0.0;
    if (field.summed) {
      for (int i = 0; i < count; ++i) distance += distance_at(i);
    } else {
      distance = largest_of(count, settings_.threads, 0.0, distance_at);
    }
    error = std::max(error, distance / field.scale);
  }
  return share * error / settings_.tolerance;
}

double StepControl::error_share(double start, double dt) const {
  if (!smooth_ || is_jump(start, dt)) return 0.0;
  // Waves shorter than `unnoticed` displace next to nothing.
  return 0.5 * dt / (dt + settings_.unnoticed);
}

bool StepControl::accept(double start, double error, bool predicted, double& dt) {
  if (settings_.given_step) return true;
  const double order = (predicted ? 2.0 : 1.0) + settings_.unnoticed / (dt + settings_.unnoticed);
  const double wanted = error > 0.0 ? implicit_thresholds.safety * std::pow(error, -1.0 / order)
                                    : implicit_thresholds.max_growth;
  accepted_error_ = error;
  if (error <= 1.0) {
    double next =
        dt * std::clamp(wanted, implicit_thresholds.min_shrinkage, implicit_thresholds.max_growth);
    if (settings_.length_alone_changes_matrix && wanted >= 1.0 &&
        wanted < implicit_thresholds.min_growth_for_new_matrix) {
      next = dt;
    }
    // A step cut short by its interval is no reason to shorten the longer one that was planned.
    next_ = !shortened_ && wanted >= 1.0 ? std::max(next, next_) : next;
    if (smooth_) settles_ = false;
    return true;
  }
  const bool spreads = settings_.pressure_spreads && settles_ && dt > shortest_change_;
  // The error jumps if it fell by less than half of what a smooth field would show.
  const bool jumps = settings_.crosses_jumps && !spreads && rejected_dt_ > 0.0 &&
                     error > 0.5 * rejected_error_ * (1.0 + dt / rejected_dt_);
  if (jumps) {
    jumped_ = settings_.starts_anew_after_jumps;
    next_ = jumped_ && !settles_ ? planned_ : dt;
    return true;
  }
  ++rejected_;
  shortened_ = true;
  rejected_dt_ = dt;
  rejected_error_ = error;
  return !shorten(
      start, std::clamp(wanted, implicit_thresholds.min_shrinkage, implicit_thresholds.max_retry),
      dt);
}

bool StepControl::shorten(double start, double factor, double& dt) {
  const double shortest = rounded(start, 2.0 * implicit_thresholds.min_step_of_time * start);
  const double shorter = rounded(start, factor * dt);
  if (!settles_ || unresolved_ >= max_unresolved() || shorter > shortest) {
    dt = shorter;
    refuse_too_short(start, dt);
    return true;
  }
  if (dt > shortest) {
    dt = shortest;
    return true;
  }
  --rejected_;
  ++unresolved_;
  next_ = dt;
  return false;
}

double StepControl::max_unresolved() const {
  return implicit_thresholds.max_unresolved / std::sqrt(settings_.tolerance);
}

void StepControl::reject(double start, double& dt) {
  ++rejected_;
  shortened_ = true;
  rejected_dt_ = 0.0;
  dt *= implicit_thresholds.unsolved_shrinkage;
  next_ = dt;
  refuse_too_short(start, dt);
}

bool StepControl::is_too_short(double start, double dt) const {
  const double at_start = std::min(implicit_thresholds.min_step_of_run * settings_.end,
                                   implicit_thresholds.min_step_of_change * shortest_change_);
  return dt <= implicit_thresholds.min_step_of_time * start || dt < at_start;
}

void StepControl::refuse_too_short(double start, double dt) const {
  if (!is_too_short(start, dt)) return;
  std::ostringstream message;
  message << "no step is short enough for time.tolerance = " << settings_.tolerance
          << " at t = " << start
          << " s: something that drives or resists the flow changes at once; take a larger "
             "tolerance or give time.step";
  throw NumericalError(message.str());
}

void StepControl::finish(double dt) {
  last_ = dt;
  smooth_ = !jumped_;
  jumped_ = false;
}

void StepControl::pass_kink() {
  settles_ = true;
  unresolved_ = 0;
}

void StepControl::grow(double dt) {
  if (!settings_.given_step) next_ = std::max(next_, implicit_thresholds.max_growth * dt);
}

void StepControl::account_for(double error) {
  if (settings_.given_step) return;
  const double relative = error / settings_.tolerance;
  accepted_error_ = std::max(accepted_error_, relative);
  if (relative > 1.0) {
    const double share = std::max(implicit_thresholds.safety * std::pow(relative, -0.5),
                                  implicit_thresholds.min_shrinkage);
    next_ = std::min(next_, share * last_);
  }
}

double StepControl::step_within(double tolerance) const {
  // An error above 1 only says that the step missed the curve altogether.
  const double error = std::min(accepted_error_ * settings_.tolerance, 1.0) / tolerance;
  const double longest = implicit_thresholds.max_growth * last_;
  return error > 0.0 ? std::min(longest, implicit_thresholds.safety * last_ / std::sqrt(error))
                     : longest;
}

}  // namespace suffuse
