#pragma once

/// Chooses the lengths of time steps so that the local error of each stays within a tolerance. The
/// error of a step is estimated as half the distance between its result and a straight line through
/// the two states before it, which for equal steps is the local error of backward Euler
/// (dt^2 |y''| / 2, Hairer and Wanner, Solving Ordinary Differential Equations II). Knows values at
/// the ends of steps, and nothing of the equations behind them.

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
  std::optional<double> given_step;  ///< longest step, s; then errors play no part
  /// Errors of steps much shorter than this count by the integral of the field over the step, not
  /// by its value, s: waves of shorter periods need not be followed.
  double unnoticed = 0.0;
  /// The matrix of a step depends on nothing but its length.
  bool length_alone_changes_matrix = false;
  /// Times at which boundary values may have a kink, ascending, s. Two of them close together are a
  /// jump, which one step crosses.
  std::vector<double> kinks;
  /// After a kink, pressure spreads from element to element: while a step is longer than that
  /// takes, its error does not fall with its length, and this is no jump.
  bool pressure_spreads = false;
  /// Fields may jump: a step whose error does not fall with its length is accepted. Seepage faces
  /// open and close at once, and no step is short enough for that.
  bool crosses_jumps = false;
  /// After such a jump the next step has the length that was planned before it, and no error that
  /// could be estimated: neither length nor slope of the jump predict anything.
  bool starts_anew_after_jumps = false;
  int threads = 1;
};

/// A field whose error decides on the length of steps, as it is at the ends of steps.
struct ControlledField {
  std::span<const double> previous;  ///< at the start of the last step; empty: predicts nothing
  std::span<const double> start;     ///< at the start of this step
  std::span<const double> end;       ///< at its end
  double scale;                      ///< errors are relative to this; zero: it has no error
  bool summed = false;  ///< the error is the sum of all values' errors, not the largest
};

class StepControl {
 public:
  explicit StepControl(StepSettings settings) : settings_(std::move(settings)) {}

  /// The first step takes `first_step` seconds, or the given one. `smooth`: the state at the start
  /// belongs to the curve that follows; otherwise the first step has no error that could be
  /// estimated. `shortest_change`: steps of this length follow all that the flow does by itself, s;
  /// infinite where nothing delays it.
  void start(double first_step, bool smooth,
             double shortest_change = std::numeric_limits<double>::infinity());

  /// Length of the step to try from `start`, s: ends at `until` at the latest, and takes no longer
  /// than `longest`. Throws as `accept` does.
  [[nodiscard]] double propose(double start, double until, double longest);
  /// Estimated local error of a step of `dt` from `start`, over the tolerance; zero where a jump or
  /// a start that is not smooth leaves nothing to compare with.
  [[nodiscard]] double error(double start, double dt,
                             const std::vector<ControlledField>& fields) const;
  /// Whether a step of this error is good enough. If so, finds the length of the next one; if not,
  /// shortens `dt`. `predicted`: a state before the start was part of the estimate. Throws
  /// NumericalError when the step would become too short to change the time, but for steps after a
  /// kink: of these some are accepted as they are.
  [[nodiscard]] bool accept(double start, double error, bool predicted, double& dt);
  /// The step of `dt` from `start` has no result: shortens it. Throws as `accept` does.
  void reject(double start, double& dt);
  /// The next step is no longer than this one.
  void hold(double dt) { next_ = std::min(next_, dt); }
  /// A step of `dt` seconds is over.
  void finish(double dt);
  /// It ended on a kink: what drives the flow may change at once from here on.
  void pass_kink();
  /// `dt`, or `left` where both are the same up to a small share.
  [[nodiscard]] static double up_to(double dt, double left);

  /// The next step may be as long as this one allows, whatever was planned: nothing changes.
  void grow(double dt);
  /// What the last step took for granted was wrong by this share: shortens the next one
  /// accordingly.
  void account_for(double error);

  /// The length that keeps another tolerance, as far as the error of the last step tells, s: no
  /// longer than what may follow that step.
  [[nodiscard]] double step_within(double tolerance) const;
  /// The next step to try takes `dt` seconds, whatever was planned.
  void plan(double dt) { next_ = dt; }

  /// Whether states so far are points of a smooth curve.
  [[nodiscard]] bool smooth() const { return smooth_; }
  [[nodiscard]] bool has_given_step() const { return settings_.given_step.has_value(); }
  [[nodiscard]] double last_step() const { return last_; }  ///< s; zero before the first
  [[nodiscard]] double next_step() const { return next_; }  ///< as it will be tried, s
  [[nodiscard]] long rejected() const { return rejected_; }

  void archive(auto& archive) {
    archive(last_, next_, smooth_, rejected_, shortest_change_, settles_, unresolved_);
  }

 private:
  [[nodiscard]] bool is_jump(double start, double dt) const;
  /// Whether a step of `dt` is too short to change the time.
  /// Steps after a kink that may be accepted for being the shortest.
  [[nodiscard]] double max_unresolved() const;
  [[nodiscard]] bool is_too_short(double start, double dt) const;
  /// Throws NumericalError where it is.
  void refuse_too_short(double start, double dt) const;
  /// Shortens `dt` after its step was rejected for its error. False where the step is the shortest
  /// that changes the time, follows a kink, and counts as accepted for that reason.
  bool shorten(double start, double factor, double& dt);

  StepSettings settings_;
  double last_ = 0.0;
  double next_ = 0.0;
  bool smooth_ = true;
  bool jumped_ = false;  ///< the step that was accepted last has crossed a jump
  long rejected_ = 0;
  double shortest_change_ = std::numeric_limits<double>::infinity();
  bool settles_ = true;     ///< no step since the start or the last kink was judged by its error
  int unresolved_ = 0;      ///< steps since then that were accepted for being the shortest
  double planned_ = 0.0;    ///< length of the step at hand, before it was rejected, s
  bool shortened_ = false;  ///< the step at hand has been rejected before
  double accepted_error_ = 0.0;  ///< of the last step, over the tolerance
  // Last rejected attempt of the step at hand.
  double rejected_dt_ = 0.0;
  double rejected_error_ = 0.0;
};

}  // namespace suffuse
