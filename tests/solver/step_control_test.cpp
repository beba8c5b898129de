/// Step control alone, on equations with known local errors.

#include "flow/step_control.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <utility>

#include "common/errors.hpp"
#include "mixed/implicit_thresholds.hpp"
#include "results/state_archive.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace step_control_test {

constexpr const ImplicitThresholds& limits = implicit_thresholds;

StepSettings settings(double tolerance, double end) {
  StepSettings result;
  result.tolerance = tolerance;
  result.end = end;
  return result;
}

/// A control that has taken a step of `dt`.
StepControl after_step(const StepSettings& s, double dt) {
  StepControl control(s);
  control.start(dt, true);
  control.finish(dt);
  return control;
}

TEST(StepControl, EstimateOfEqualStepsIsTheLocalErrorOfBackwardEuler) {
  // y' = -y by backward Euler: y falls by 1 / (1 + dt) per step, the exact solution by exp(-dt).
  std::vector<double> off;
  for (const double dt : {0.04, 0.02, 0.01}) {
    const std::vector<double> previous{1.0 + dt};
    const std::vector<double> start{1.0};
    const std::vector<double> end{1.0 / (1.0 + dt)};
    const StepControl control = after_step(settings(1e-3, 10.0), dt);
    const double estimated = 1e-3 * control.error(1.0, dt, {{previous, start, end, 1.0}});
    const double exact = end[0] - std::exp(-dt);
    off.push_back(estimated / exact - 1.0);
    const double from_line = end[0] - (2.0 * start[0] - previous[0]);
    EXPECT_NEAR(control.error_share(1.0, dt) * from_line, estimated, 1e-15);
  }
  EXPECT_LE(off.back(), 0.01);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::log2(off[i] / off[i + 1]), 1.0, 0.1);
}

TEST(StepControl, ErrorsAreTheLargestOverScalesAndCountLessWhereNotNoticed) {
  StepSettings s = settings(1e-2, 10.0);
  const std::vector<double> zero(3, 0.0);
  const std::vector<double> a{0.0, -0.4, 0.1};
  const std::vector<double> b{8.0, 0.0, 0.0};
  const StepControl control = after_step(s, 1.0);
  const std::vector<ControlledField> fields{
      {{}, zero, a, 1.0}, {{}, zero, b, 10.0}, {{}, zero, b, 0.0}};
  EXPECT_DOUBLE_EQ(control.error(0.0, 1.0, fields), 0.5 * 0.8 / 1e-2);
  s.unnoticed = 3.0;
  EXPECT_DOUBLE_EQ(after_step(s, 1.0).error(0.0, 1.0, fields), 0.25 * 0.5 * 0.8 / 1e-2);
}

struct Integration {
  double max_local_error = 0.0;
  long steps = 0;
  long rejected = 0;
};

/// y' = -y from 1 to time 6 by backward Euler under step control.
Integration integrate_decay(double tolerance) {
  constexpr double end = 6.0;
  StepControl control(settings(tolerance, end));
  control.start(1e-4, true);
  Integration result;
  std::vector<double> now{1.0};
  std::vector<double> previous;
  double time = 0.0;
  while (time < end) {
    double dt = control.propose(time, end, end);
    std::vector<double> next;
    do {
      next = {now[0] / (1.0 + dt)};
    } while (!control.accept(time, control.error(time, dt, {{previous, now, next, 1.0}}),
                             !previous.empty(), dt));
    result.max_local_error =
        std::max(result.max_local_error, std::abs(next[0] - now[0] * std::exp(-dt)));
    control.finish(dt);
    previous = std::exchange(now, next);
    time += dt;
    ++result.steps;
  }
  result.rejected = control.rejected();
  return result;
}

TEST(StepControl, LocalErrorsMeetTheToleranceAndStepsAreOfItsSquareRoot) {
  std::vector<double> steps;
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6}) {
    const Integration run = integrate_decay(tolerance);
    std::cout << "tolerance " << tolerance << ": " << run.steps << " steps, " << run.rejected
              << " rejected, largest local error " << run.max_local_error / tolerance
              << " of the tolerance\n";
    EXPECT_LE(run.max_local_error, tolerance);
    EXPECT_GE(run.max_local_error, 0.5 * tolerance);
    EXPECT_LE(run.rejected, 2);
    steps.push_back(static_cast<double>(run.steps));
  }
  // A local error of dt^2 y'' / 2 allows steps of the square root of the tolerance.
  EXPECT_NEAR(std::log10(steps[3] / steps[2]), 0.5, 0.05);
}

TEST(StepControl, FindsTheLengthWhoseErrorIsTheTolerance) {
  // The error is (dt / 2)^2, so the longest step is 2 s.
  for (const double first : {1e-3, 1.0, 1.9, 2.1, 50.0}) {
    StepControl control(settings(1e-3, 1e6));
    control.start(first, true);
    double time = 0.0;
    for (int step = 0; step < 12; ++step) {
      double dt = control.propose(time, 1e6, 1e6);
      while (!control.accept(time, dt * dt / 4.0, true, dt)) continue;
      control.finish(dt);
      time += dt;
      EXPECT_LE(dt, 2.0);
      EXPECT_LE(control.next_step(), limits.max_growth * dt);
    }
    EXPECT_NEAR(control.next_step(), limits.safety * 2.0, 1e-3) << first;
  }
}

TEST(StepControl, ErrorsThatDoNotFallWithTheStepEndTheRun) {
  StepControl control = after_step(settings(1e-3, 100.0), 1.0);
  double dt = control.propose(49.0, 100.0, 100.0);
  EXPECT_TRUE(control.accept(49.0, 0.5, true, dt));
  dt = control.propose(50.0, 100.0, 100.0);
  const auto try_on = [&] {
    while (!control.accept(50.0, 2.0, true, dt)) continue;
  };
  EXPECT_THROW(try_on(), NumericalError);
  EXPECT_LE(dt, 1e-14 * 50.0);
  EXPECT_GE(control.rejected(), 20);
}

/// Errors of steps after a kink that are small only in steps shorter than the resolution of time.
TEST(StepControl, AfterAKinkStepsAreAsShortAsTimeHasDigits) {
  constexpr double kink = 1e9;
  StepControl control = after_step(settings(1e-3, 3e9), 1e7);
  control.pass_kink();
  double time = kink;
  const auto step = [&](double error) {
    double dt = control.propose(time, 2e9, 1e9);
    while (!control.accept(time, error, true, dt)) continue;
    control.finish(dt);
    EXPECT_EQ((time + dt) - time, dt);
    EXPECT_GT(dt, limits.min_step_of_time * time);
    EXPECT_LT(dt, 3.0 * limits.min_step_of_time * time);
    time += dt;
  };
  for (int i = 0; i < limits.max_unresolved / std::sqrt(1e-3); ++i) step(2.0);
  // Errors that last longer are not caused by the kink.
  EXPECT_THROW(step(2.0), NumericalError);
  control.pass_kink();
  step(2.0);
  step(0.5);
  EXPECT_THROW(step(2.0), NumericalError);
}

/// Half of the remaining time would be shorter than the resolution of time allows.
TEST(StepControl, StepsAreNotHalvedBelowTheDigitsOfTime) {
  constexpr double kink = 1e9;
  StepControl control = after_step(settings(1e-3, 3e9), 1e7);
  control.pass_kink();
  double dt = control.propose(kink, 2e9, 1e9);
  while (!control.accept(kink, 2.0, true, dt)) continue;
  control.finish(dt);
  const double left = 1.5 * limits.min_step_of_time * kink;
  EXPECT_GE(control.propose(kink, kink + left, 1e9), limits.min_step_of_time * kink);
}

TEST(StepControl, StartsHoweverFarTheEndWhereTheFlowChangesFast) {
  for (const double shortest : {1e-8, std::numeric_limits<double>::infinity()}) {
    StepControl control(settings(1e-3, 1e15));
    const double first = std::min(shortest, 1e-6);
    control.start(first, false, shortest);
    if (std::isfinite(shortest)) {
      EXPECT_EQ(control.propose(0.0, 1e15, 1e15), first);
    } else {
      EXPECT_THROW((void)control.propose(0.0, 1e15, 1e15), NumericalError);
    }
  }
}

/// A load is applied at once at a face that drains: the error stays until a step is shorter than
/// the time in which pressure spreads through an element.
TEST(StepControl, PressureThatSpreadsAfterAKinkIsNoJump) {
  StepSettings s = settings(1e-3, 1e5);
  s.crosses_jumps = s.starts_anew_after_jumps = true;
  constexpr double spreads_within = 10.0;
  const auto first_step = [&](bool spreads, bool after_kink) {
    s.pressure_spreads = spreads;
    StepControl control(s);
    control.start(1e3, true, 0.01 * spreads_within);
    double dt = control.propose(0.0, 1e5, 1e5);
    if (!after_kink) {
      EXPECT_TRUE(control.accept(0.0, 0.5, true, dt));
    }
    dt = control.propose(1e3, 1e5, 1e5);
    while (!control.accept(1e3, 500.0 * std::min(1.0, dt / spreads_within), false, dt)) continue;
    return dt;
  };
  EXPECT_GT(first_step(false, true), spreads_within);
  EXPECT_GT(first_step(true, false), spreads_within);
  EXPECT_LE(first_step(true, true), spreads_within / 500.0);
}

/// The error of the step after a jump is not estimated, so it must not have a length that no error
/// has judged: a load within a second and rows of months made one step of the first month.
TEST(StepControl, AStepAfterAJumpRightAfterAKinkIsAsLongAsTheJump) {
  StepSettings s = settings(1e-3, 1e6);
  s.crosses_jumps = s.starts_anew_after_jumps = s.pressure_spreads = true;
  const auto lengths = [&](bool after_kink) {
    StepControl control(s);
    control.start(1e4, true, 100.0);
    double start = 0.0;
    if (!after_kink) {
      double dt = control.propose(start, 1e6, 1e6);
      EXPECT_TRUE(control.accept(start, 0.9, false, dt));
      control.finish(dt);
      start = dt;
    }
    double dt = control.propose(start, 1e6, 1e6);
    const double planned = dt;
    while (!control.accept(start, 500.0, true, dt)) continue;
    control.finish(dt);
    return std::array<double, 3>{planned, dt, control.propose(start + dt, 1e6, 1e6)};
  };
  const auto [planned, jump, next] = lengths(true);
  EXPECT_LT(jump, 0.1 * planned);
  EXPECT_EQ(next, jump);
  const auto [planned_later, jump_later, next_later] = lengths(false);
  EXPECT_LT(jump_later, 0.2 * planned_later);
  EXPECT_EQ(next_later, planned_later);
}

TEST(StepControl, StepsEndOnTheEndOfTheIntervalWithoutShortOnes) {
  model::Uniform uniform(5);
  for (int i = 0; i < 1000; ++i) {
    const double next = std::exp(3.0 * uniform());
    StepControl control(settings(1e-3, 1e6));
    control.start(next, true);
    double time = 10.0;
    const double until = 10.0 + std::exp(3.0 * uniform());
    int steps = 0;
    while (time < until) {
      const double dt = control.propose(time, until, 1e9);
      EXPECT_LE(dt, next * (1.0 + 1e-8));
      EXPECT_GE(dt, std::min(0.5 * next, (until - 10.0)) * (1.0 - 1e-8));
      time = dt < until - time ? time + dt : until;
      ++steps;
    }
    EXPECT_LE(steps, std::ceil((until - 10.0) / next) + 1e-8);
  }
}

TEST(StepControl, GivenStepsDivideTheIntervalEvenly) {
  StepSettings s = settings(1e-3, 100.0);
  s.given_step = 0.0851;
  StepControl control(s);
  control.start(77.0, false);
  EXPECT_DOUBLE_EQ(control.propose(3.0, 4.0, 1e9), 1.0 / 12.0);
  EXPECT_DOUBLE_EQ(control.propose(3.0, 3.0 + 2.0 * 0.0851, 1e9), 0.0851);
  double dt = 0.0851;
  EXPECT_TRUE(control.accept(3.0, 1e9, true, dt));
  control.account_for(1e9);
  control.grow(1e9);
  EXPECT_EQ(control.next_step(), 0.0851);
}

TEST(StepControl, ProposesNoStepThatIsTooShortToChangeTheTime) {
  const StepSettings s = settings(1e-3, 100.0);
  StepControl control = after_step(s, 1e-12);
  // The step is rounded to a number that can be added to the time.
  EXPECT_EQ(control.propose(0.8, 10.0, 1e9), (0.8 + 1e-12) - 0.8);
  for (int k = 0; k < 3; ++k) {
    control.account_for(1e9);
    control.finish(control.next_step());
  }
  EXPECT_THROW((void)control.propose(0.8, 10.0, 1e9), NumericalError);
}

TEST(StepControl, CrossesJumpsInOneStepWithoutAnError) {
  StepSettings s = settings(1e-3, 100.0);
  const double jump = 0.9 * 1e-12 * 100.0 / 1e-3;
  s.kinks = {20.0, 20.0 + jump, 40.0, 40.0 + 2.0 * jump};
  StepControl control = after_step(s, 1e-12);
  const std::vector<double> before{0.0};
  const std::vector<double> after{1e6};
  const std::vector<ControlledField> fields{{{}, before, after, 1.0}};
  EXPECT_EQ(control.propose(20.0, 20.0 + jump, 1e9), (20.0 + jump) - 20.0);
  EXPECT_EQ(control.error(20.0, jump, fields), 0.0);
  EXPECT_GT(control.error(20.0, 0.5 * jump, fields), 1e6);
  // If the flow itself changes within that time, steps follow it.
  control.start(1.0, true, 0.5 * jump);
  EXPECT_GT(control.error(20.0, jump, fields), 1e6);
  EXPECT_GT(control.error(40.0, 2.0 * jump, fields), 1e6);
}

TEST(StepControl, AnIntervalThatEndsEarlyDoesNotShortenLaterSteps) {
  StepControl control(settings(1e-3, 100.0));
  control.start(5.0, true);
  double dt = control.propose(0.0, 0.1, 1e9);
  EXPECT_EQ(dt, 0.1);
  EXPECT_TRUE(control.accept(0.0, 1e-3, true, dt));
  EXPECT_EQ(control.next_step(), 5.0);
}

TEST(StepControl, WhereTheLengthAloneChangesTheMatrixItChangesByALotOrNotAtAll) {
  StepSettings s = settings(1e-3, 100.0);
  s.length_alone_changes_matrix = true;
  for (const double growth : {1.2, 1.49, 1.51, 3.0}) {
    StepControl control(s);
    control.start(1.0, true);
    double dt = control.propose(0.0, 100.0, 100.0);
    const double error = std::pow(limits.safety / growth, 2);
    ASSERT_TRUE(control.accept(0.0, error, true, dt));
    EXPECT_NEAR(control.next_step(), growth < 1.5 ? 1.0 : growth, 1e-12);
  }
}

TEST(StepControl, GoesOnAsArchived) {
  StepControl control = after_step(settings(1e-3, 100.0), 2.0);
  double dt = control.propose(0.0, 100.0, 100.0);
  EXPECT_FALSE(control.accept(0.0, 4.0, true, dt));
  StateArchive stored;
  control.archive(stored);
  StateArchive restored(stored.finish());
  StepControl other(settings(1e-3, 100.0));
  other.archive(restored);
  restored.finish();
  EXPECT_EQ(other.last_step(), 2.0);
  EXPECT_EQ(other.next_step(), control.next_step());
  EXPECT_EQ(other.rejected(), 1);
}

}  // namespace step_control_test
}  // namespace suffuse
