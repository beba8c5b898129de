#pragma once

/// Takes moving soil from equilibrium to inertia and back by the table of
/// docs/theory/moving-soil.md, "When soil fails". No other class starts or ends inertia, or knows
/// the scene's `time.failure`.

#include <string>

#include "coupling/repeated_failure.hpp"
#include "flow/flow_step.hpp"
#include "motion/moving_skeleton.hpp"

namespace suffuse {

template <int Dim>
class Failure {
 public:
  /// Longest motion in a step in equilibrium if failure is followed, over the height of an element:
  /// a slide must not pass within a long step.
  static constexpr double watched_travel = 0.05;

  /// Keeps a reference. `follows`: soil that loses its equilibrium gets inertia; otherwise the run
  /// stops.
  Failure(const Grid<Dim>& grid, MovingSkeleton<Dim>& solid, bool follows)
      : grid_(grid), solid_(solid), follows_(follows) {}

  [[nodiscard]] bool has_inertia() const { return solid_.has_inertia(); }
  /// Longest motion of the next step, over the height of an element there.
  [[nodiscard]] double longest_travel() const { return watches() ? watched_travel : max_travel; }
  /// Time of the last loss of equilibrium, s; 0: never, or at the start.
  [[nodiscard]] double time() const { return has_failed() ? time_ : 0.0; }
  [[nodiscard]] bool has_failed() const { return time_ >= 0.0; }

  /// Whether steps have become so short that the run makes no progress: all those with inertia, or
  /// those in equilibrium of which most trials have no solution.
  [[nodiscard]] bool is_stuck() const;

  // From equilibrium to inertia, or to the end of the run.

  /// Starts inertia if the soil has no equilibrium. Throws NumericalError if it is not followed.
  void start(const StartStress& found);
  /// Call when a trial of a step from `time`, s, has no solution.
  void count_unsolved(double time);
  /// Starts inertia, as the step from `time`, s, has no solution and cannot be shortened, or the
  /// run is stuck. Throws EquilibriumLost if the soil has inertia already, or if the scene does not
  /// follow failure.
  void step_unsolved(double time, const Unsolved& why);
  /// Call after a step that ended at `time`, s; the next one has `next_step`, s. Soil in
  /// equilibrium gets inertia if steps become much shorter than the time of a fall, or if it moves
  /// as fast as it falls freely.
  void finish_step(double time, double next_step, const SoilKinetics& soil);
  /// Call when what drives flow or motion changes at once: short steps are expected then.
  void expect_short_steps() { long_steps_ = false; }

  // From inertia to equilibrium, or to the end of the run.

  /// Call at the end of a step with inertia, of `duration`, s. Ends the inertia of soil that has
  /// been at rest for the time of a fall through its height.
  void finish_motion(double duration, const SoilKinetics& soil);

  void archive(auto& archive) {
    archive(repeated_, time_, rested_, long_steps_, counted_steps_, counted_time_, is_stuck_,
            unsolved_, unsolved_since_);
  }

 private:
  /// Whether the soil is in equilibrium and gets inertia when it loses it.
  [[nodiscard]] bool watches() const { return follows_ && !has_inertia(); }
  void start_inertia(double time);
  [[noreturn]] void refuse(double time, const Unsolved& why) const;

  const Grid<Dim>& grid_;
  MovingSkeleton<Dim>& solid_;
  bool follows_;
  RepeatedFailure<Dim> repeated_;
  double time_ = -1.0;         ///< of the last loss of equilibrium, s; below 0: never
  double rested_ = 0.0;        ///< soil with inertia has been at rest for this time, s
  bool long_steps_ = false;    ///< a long step has followed the last sudden change
  int counted_steps_ = 0;      ///< steps with inertia since they were last counted ...
  double counted_time_ = 0.0;  ///< ... and their time, s
  bool is_stuck_ = false;      ///< those steps made no progress
  int unsolved_ = 0;           ///< trials in equilibrium that have had no solution ...
  double unsolved_since_ = 0;  ///< ... since this time, s
};

}  // namespace suffuse
