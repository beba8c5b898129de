#pragma once

/// The fixed numbers of the implicit flow: how much one step may differ from the last, how fast
/// corrections act, how near to steady is steady, and what is round-off. The scene's tolerance is
/// the only one a user chooses. Numbers without a unit are ratios.

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
  /// Share of the run below which such a step ends the run where the soil has inertia: with inertia
  /// a shorter step is easier.
  double min_unsolved_inertial_step = 1e-12;
  /// The longest step of soil with inertia that may follow one, in lengths of that one.
  double inertial_growth = 1.5;
  /// No step grows after one whose iteration took more solutions than this.
  int slow_iterations = 25;
  /// The next step's length, in lengths of the step whose error is expected to equal the tolerance.
  double safety = 0.85;
  /// Where the length alone changes the matrix, a step grows by at least this factor or not at all:
  /// less is not worth a factorisation.
  double min_growth_for_new_matrix = 1.5;
  /// A step that misses the end of its interval by less than this share of itself ends there.
  double end_margin = 1e-9;
  /// The first step, as a share of the shortest time in which the flow changes (from rest) or of
  /// the run (from a steady flow).
  double first_step = 1e-2;
  /// Boundary values jump that change within this share of the run, divided by the tolerance, and
  /// within the shortest time in which the flow changes: one step crosses them.
  double jump = 1e-12;
  /// A step below this share of the time reached is too short: adding it leaves few digits.
  double min_step_of_time = 1e-14;
  /// Boundary values that change within so many of these shortest steps jump as well.
  double unresolved_steps = 8.0;
  /// After a kink at most so many shortest steps in succession, over the root of the tolerance, are
  /// accepted whatever their error: what happens meanwhile is faster than time has digits. Of what
  /// spreads from a jump step n of equal ones errs by a half over n squared.
  double max_unresolved = 2.0;
  /// Steps below this share of the time reached are rounded to what can be added to that time.
  double rounded_step = 1e-10;
  /// At the start a step below this share of the run is too short ...
  double min_step_of_run = 1e-20;
  /// ... if it is below this share of the shortest time in which the flow changes, too.
  double min_step_of_change = 1e-10;

  /// Errors of fluxes in unsaturated soil that last for less than this share of the run count by
  /// the volume that they misplace: on a coarse mesh a front moves by fits and starts.
  double passing_flux = 0.01;

  // Fading of a difference over steps (MassRelaxation and CoefficientBlending).

  /// The time in which a step closes a difference is the longest of recent steps, where each later
  /// step takes this share of its own length off. With the last step alone, one that was shortened
  /// by the difference itself would be followed by ever shorter ones.
  double fading = 0.5;

  // Release of the mass error (MassRelaxation).

  /// Water that does not fit its pores leaves over at least this many steps: all at once, the flux
  /// would jump, and no step is short enough for a jump.
  double release_steps = 4.0;
  /// Steps in which the flow fills an element fewer times than this are short: water that expands
  /// leaves in the steps that follow.
  double expansion_time = 200.0;
  /// A longer step is solved again where moving water expands otherwise than in the step before by
  /// more than this share of what an element holds.
  double expansion = 1e-4;
  /// At most so many times: each leaves a share p / K of the difference.
  int expansion_repeats = 10;
  /// A change of volume below this share of the volume is round-off: 16 units in the last place.
  double volume_round_off = 16.0 * 2.220446049250313e-16;

  // Blending of coefficients (CoefficientBlending).

  /// After a breakpoint, coefficients reach their new values within this share of the step before
  /// it, as soil that starts to erode may change its resistance at once.
  double breakpoint_blending = 1e-2;

  // Levels of reservoirs.

  /// A level fits what seeps when it differs by less than this share of the scale of heads.
  double reservoir_level = 1e-10;
  /// Solutions of a step until a shorter one is tried.
  int max_reservoir_tries = 20;

  // Reuse of a steady flow (SteadyReuse).

  /// A flow is steady when it differs from the steady solution by less than this share of the
  /// tolerance.
  double steady = 0.02;
  /// A steady flow is solved again when its sources have changed by this share of the tolerance.
  double steady_update = 0.01;
  /// Resistances that differ by less than this share are equal.
  double resistance_round_off = 1e-12;

  // Scales of errors (FlowScales).

  /// This share of a hydrostatic pressure over the height of the model, of the flux that such a
  /// pressure drives, and of an element's water per duration of the run counts as nothing: water
  /// at rest flows by round-off, and no step is short enough for the relative error of that.
  double nothing = 1e-9;
  /// Stresses of soil that moves count as nothing at such a strain.
  double nothing_strain = 1e-8;
  /// Pressures below this share of the bulk modulus are round-off of the equation of state.
  double state_round_off = 1e-12;
  /// Cosines of angles above this, negative, are obtuse.
  double obtuse_cosine = 1e-9;
};

inline constexpr ImplicitThresholds implicit_thresholds;

}  // namespace suffuse
