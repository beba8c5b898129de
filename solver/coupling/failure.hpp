#pragma once

/// Whether soil that moves is in equilibrium or has inertia, and how the one becomes the other: the
/// table of docs/theory.md, "When soil fails". No other place starts or ends inertia, and no other
/// knows the scene's `time.failure`.

#include <string>

#include "coupling/repeated_failure.hpp"
#include "flow/flow_step.hpp"
#include "motion/moving_skeleton.hpp"

namespace suffuse {

template <int Dim>
class Failure {
 public:
  /// A step in equilibrium may move soil that is to be followed by no more than this share of an
  /// element's height: a slide must not pass within a long step.
  static constexpr double watched_travel = 0.05;

  /// Keeps a reference. `follows`: soil that loses its equilibrium gets inertia; otherwise the run
  /// stops there.
  Failure(const Grid<Dim>& grid, MovingSkeleton<Dim>& solid, bool follows)
      : grid_(grid), solid_(solid), follows_(follows) {}

  [[nodiscard]] bool has_inertia() const { return solid_.has_inertia(); }
  /// Longest motion of the next step, over the height of an element there.
  [[nodiscard]] double longest_travel() const { return watches() ? watched_travel : max_travel; }
  /// When equilibrium was lost last, s; 0: never, or at the start.
  [[nodiscard]] double time() const { return time_; }

  // From equilibrium to inertia, or to the end of the run.

  /// At the start. Throws NumericalError where the soil does not stand and is not followed.
  void start(const StartStress& found);
  /// The step from `time`, s, has no solution, and is as short as steps get. Throws EquilibriumLost
  /// if the soil has inertia already, or if the scene does not let it move on.
  void step_unsolved(double time, const Unsolved& why);
  /// A step ended at `time`, s; the next will be of `next_step`, s. In equilibrium, steps that get
  /// much shorter than the time of a fall start inertia, and so does soil that moves as fast as it
  /// falls freely.
  void finish_step(double time, double next_step, const SoilKinetics& soil);
  /// What drives flow or motion changes at once: short steps follow for that reason.
  void expect_short_steps() { long_steps_ = false; }

  // From inertia to equilibrium, or to the end of the run.

  /// A step with inertia, of `duration`, s, ends at `time`, s. Soil that has been at rest for the
  /// time of a fall through its height has no inertia any more.
  void finish_motion(double time, double duration, const SoilKinetics& soil);
  /// Throws EquilibriumLost where the soil loses its equilibrium again and again without going
  /// anywhere. \param time  at the start of a step, s
  void refuse_creep(double time) const;

  void archive(auto& archive) { archive(repeated_, time_, rested_, long_steps_); }

 private:
  /// Whether the soil is in equilibrium, and inertia is to follow when it is lost.
  [[nodiscard]] bool watches() const { return follows_ && !has_inertia(); }
  void start_inertia(double time);
  [[noreturn]] void refuse(double time, const Unsolved& why) const;

  const Grid<Dim>& grid_;
  MovingSkeleton<Dim>& solid_;
  bool follows_;
  RepeatedFailure<Dim> repeated_;
  double time_ = 0.0;        ///< see `time`
  double rested_ = 0.0;      ///< for so long soil with inertia has been at rest, s
  bool long_steps_ = false;  ///< there have been some since something changed at once
};

}  // namespace suffuse
