#pragma once

/// Chooses the lengths of time steps so that the local error of each stays within a tolerance. The
/// error is estimated as half the distance between the result of a step and a straight line through
/// the two states before it. For equal steps this is the local error of backward Euler (dt^2 |y''|
/// / 2, Hairer and Wanner, Solving Ordinary Differential Equations II). This class knows values at
/// the ends of steps, but no equations.

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace suffuse {

struct StepSettings {
  double tolerance = 0.0;            ///< for the local error of a step over the field's scale
  double end = 0.0;                  ///< of the run, s
  std::optional<double> given_step;  ///< longest step, s; errors are ignored then
  /// Errors of steps much shorter than this count by the integral of the field over the step, not
  /// by its value, s: waves of shorter periods need not be resolved.
  double unnoticed = 0.0;
  /// The matrix of a step depends on its length only.
  bool length_alone_changes_matrix = false;
  /// Times at which boundary values may have a kink, ascending, s. Two of them close together are a
  /// jump, which one step crosses.
  std::vector<double> kinks;
  /// After a kink, pressure spreads from element to element. The error of a step longer than this
  /// spreading does not fall with its length, but this is not a jump.
  bool pressure_spreads = false;
  /// Fields may jump, as when seepage faces open: a step whose error does not fall with its length
  /// is accepted, as no step is short enough.
  bool crosses_jumps = false;
  /// The error of the step after such a jump is not estimated: neither length nor slope of the jump
  /// predict anything. It has the length planned before the jump, or that of the jump where no step
  /// since the last kink was judged by its error.
  bool starts_anew_after_jumps = false;
  int threads = 1;
};

/// A field whose error controls the length of steps, by its values at the ends of steps.
struct ControlledField {
  std::span<const double> previous;  ///< at the start of the last step; empty: no prediction
  std::span<const double> start;     ///< of this step
  std::span<const double> end;       ///< of this step
  double scale;                      ///< of errors; zero: the field's error is ignored
  bool summed = false;  ///< the error is the sum of all values' errors, not the largest
};

class StepControl {
 public:
  explicit StepControl(StepSettings settings) : settings_(std::move(settings)) {}

  /// The first step takes `first_step` seconds, or the given one. `smooth`: the initial state
  /// belongs to the curve that follows; otherwise the error of the first step is not estimated.
  /// `shortest_change`: steps of this length resolve the flow's own changes, s; infinite if nothing
  /// delays the flow.
  void start(double first_step, bool smooth,
             double shortest_change = std::numeric_limits<double>::infinity());

  /// Length of the step to try from `start`, s; it ends at `until` at the latest and is no longer
  /// than `longest`. Throws as `accept` does.
  [[nodiscard]] double propose(double start, double until, double longest);
  /// Estimated local error of a step of `dt` from `start`, over the tolerance; zero if a jump or a
  /// start that is not smooth prevents an estimate.
  [[nodiscard]] double error(double start, double dt,
                             const std::vector<ControlledField>& fields) const;
  /// Share of the distance from that straight line which is the error; zero under the conditions
  /// under which `error` is.
  [[nodiscard]] double error_share(double start, double dt) const;
  /// Whether a step of this error is accurate enough. If so, chooses the length of the next one; if
  /// not, shortens `dt`. `predicted`: a state before the start was part of the estimate. Throws
  /// NumericalError when the step would become too short to change the time, except after a kink,
  /// where some such steps are accepted.
  [[nodiscard]] bool accept(double start, double error, bool predicted, double& dt);
  /// Shortens the step of `dt` from `start`, which has no result. Throws as `accept` does.
  void reject(double start, double& dt);
  /// Bounds the length of the next step by this one.
  void hold(double dt) { next_ = std::min(next_, dt); }
  /// Call at the end of a step of `dt` seconds.
  void finish(double dt);
  /// Call if the step ended on a kink: what drives the flow may change at once from here on.
  void pass_kink();
  /// `dt`, or `left` where both are the same up to a small share.
  [[nodiscard]] static double up_to(double dt, double left);

  /// Lets the next step grow as much as this one allows, whatever was planned.
  void grow(double dt);
  /// Shortens the next step for an assumption of the last one that was wrong by this share.
  void account_for(double error);

  /// The length that keeps another tolerance, estimated from the error of the last step, s; at most
  /// the longest that may follow that step.
  [[nodiscard]] double step_within(double tolerance) const;
  /// Sets the length of the next step, s, whatever was planned.
  void plan(double dt) { next_ = dt; }

  /// Whether states so far are points of a smooth curve.
  [[nodiscard]] bool smooth() const { return smooth_; }
  [[nodiscard]] bool has_given_step() const { return settings_.given_step.has_value(); }
  [[nodiscard]] double last_step() const { return last_; }  ///< s; zero before the first
  [[nodiscard]] double next_step() const { return next_; }  ///< length to be tried, s
  [[nodiscard]] long rejected() const { return rejected_; }
  /// Whether a longer step was tried before the present one.
  [[nodiscard]] bool has_shortened() const { return shortened_; }

  void archive(auto& archive) {
    archive(last_, next_, smooth_, rejected_, shortest_change_, settles_, unresolved_);
  }

 private:
  [[nodiscard]] bool is_jump(double start, double dt) const;
  /// Largest number of steps after a kink that may be accepted for being the shortest.
  [[nodiscard]] double max_unresolved() const;
  /// Whether a step of `dt` is too short to change the time.
  [[nodiscard]] bool is_too_short(double start, double dt) const;
  /// Throws NumericalError if `dt` is too short.
  void refuse_too_short(double start, double dt) const;
  /// Shortens `dt` after its step was rejected for its error. False if the step is the shortest
  /// that changes the time, follows a kink, and is therefore accepted.
  bool shorten(double start, double factor, double& dt);

  StepSettings settings_;
  double last_ = 0.0;
  double next_ = 0.0;
  bool smooth_ = true;
  bool jumped_ = false;  ///< the step accepted last has crossed a jump
  long rejected_ = 0;
  double shortest_change_ = std::numeric_limits<double>::infinity();
  bool settles_ = true;     ///< no step since the start or the last kink was judged by its error
  int unresolved_ = 0;      ///< steps since the last kink accepted for being the shortest
  double planned_ = 0.0;    ///< length of the current step before it was rejected, s
  bool shortened_ = false;  ///< the current step has been rejected before
  double accepted_error_ = 0.0;  ///< of the last step, over the tolerance
  // Last rejected attempt of the current step.
  double rejected_dt_ = 0.0;
  double rejected_error_ = 0.0;
};

}  // namespace suffuse
