#pragma once

/// The fixed numbers of the implicit flow: differences allowed between steps, rates of corrections,
/// the limits of a steady flow and of round-off. A user chooses the scene's tolerance only. Numbers
/// without a unit are ratios.

namespace suffuse {

struct ImplicitThresholds {
  // Lengths of steps (StepControl).

  /// The longest step that may follow a step, in lengths of that step.
  double max_growth = 4.0;
  /// The shortest step that may follow a step or replace a rejected one, in lengths of that one.
  double min_shrinkage = 0.1;
  /// The longest step that may replace a rejected one, in lengths of that one.
  double max_retry = 0.9;
  /// The step that replaces one whose iteration did not converge, in lengths of that one.
  double unsolved_shrinkage = 0.25;
  /// A step below this share of the run whose iteration does not converge ends the run.
  double min_unsolved_step = 1e-9;
  /// The same limit for soil with inertia, lower because a shorter step is then easier to solve.
  double min_unsolved_inertial_step = 1e-12;
  /// The longest step that may follow one of soil with inertia that was not shortened, in lengths.
  double inertial_growth = 1.2;
  /// Steps do not grow after one whose iteration took more solutions than this.
  int slow_iterations = 25;
  /// The next step's length, in lengths of the step whose error is expected to equal the tolerance.
  double safety = 0.85;
  /// Where only the length changes the matrix, a step grows by at least this factor or not at all:
  /// smaller growth is not worth a factorization.
  double min_growth_for_new_matrix = 1.5;
  /// A step that misses the end of its interval by less than this share of itself ends there.
  double end_margin = 1e-9;
  /// The first step, as a share of the shortest time in which the flow changes (from rest) or of
  /// the run (from a steady flow).
  double first_step = 1e-2;
  /// Boundary values jump, within one step, if they change within this share of the run divided by
  /// the tolerance and within the shortest time in which the flow changes.
  double jump = 1e-12;
  /// A step below this share of the time reached is too short: adding it leaves few digits.
  double min_step_of_time = 1e-14;
  /// Boundary values that change within this many of these shortest steps jump as well.
  double unresolved_steps = 8.0;
  /// Number of shortest steps after a kink that are accepted whatever their error, times the root
  /// of the tolerance: time has no digits to resolve faster changes. If a jump diffuses, the error
  /// of step n of equal ones is 1 / (2 n^2).
  double max_unresolved = 2.0;
  /// Steps below this share of the time reached are rounded to differences of two times.
  double rounded_step = 1e-10;
  /// A step at the start is too short if it is below both: this share of the run,
  double min_step_of_run = 1e-20;
  /// and this share of the shortest time in which the flow changes.
  double min_step_of_change = 1e-10;

  /// Flux errors in unsaturated soil that last for less than this share of the run are weighted
  /// with their duration, as a front moves in jerks on a coarse mesh.
  double passing_flux = 0.01;

  // Fading of a difference over steps (MassRelaxation and CoefficientBlending).

  /// A difference is closed over the longest of recent steps; each later step takes this share of
  /// its own length off. With the last step alone, a step that was shortened by the difference
  /// itself would be followed by ever shorter ones.
  double fading = 0.5;

  // Release of the mass error (MassRelaxation).

  /// Excess water leaves an element over at least this many steps. Released at once it would make
  /// the flux jump, and no step is short enough for a jump.
  double release_steps = 4.0;
  /// If the flow fills an element less often than this in a step, the expansion of moving water is
  /// released in the following steps.
  double expansion_time = 200.0;
  /// A longer step is solved again if it leaves more than this share of an element's water without
  /// room in its pores.
  double expansion = 1e-4;
  /// Largest number of repeats; each leaves a share p / K of the difference.
  int expansion_repeats = 10;
  /// A change of volume below this share of the volume is round-off: 16 units in the last place.
  double volume_round_off = 16.0 * 2.220446049250313e-16;

  // Blending of coefficients (CoefficientBlending).

  /// After a breakpoint, coefficients reach their new values within this share of the last step, as
  /// soil that starts to erode may change its resistance at once.
  double breakpoint_blending = 1e-2;

  // Reuse of a steady flow (SteadyReuse).

  /// A flow is steady when it differs from the steady solution by less than this share of the
  /// tolerance.
  double steady = 0.02;
  /// A steady flow is solved again when its sources have changed by this share of the tolerance.
  double steady_update = 0.01;
  /// Resistances that differ by less than this share are equal.
  double resistance_round_off = 1e-12;

  // Scales of errors (FlowScales).

  /// This share counts as nothing: of a hydrostatic pressure over the height of the model, of the
  /// flux that it drives, and of an element's water per duration of the run. Water at rest flows by
  /// round-off, and no step is short enough for a relative error of that.
  double nothing = 1e-9;
  /// Stresses of moving soil at this strain count as nothing.
  double nothing_strain = 1e-8;
  /// Pressures below this share of the bulk modulus are round-off of the equation of state.
  double state_round_off = 1e-12;
};

inline constexpr ImplicitThresholds implicit_thresholds;

}  // namespace suffuse
