#pragma once

/// The motion of a skeleton over one step, as it is tried. Nothing of the skeleton changes until it
/// commits the step.

#include <memory>
#include <vector>

#include "motion/motion_flux.hpp"

namespace suffuse {

/// A motion by more than this share of an element's height has no solution: points would pass
/// elements unseen.
inline constexpr double max_travel = 0.5;

/// What a step of the skeleton is given, pressures apart.
struct MotionForcing {
  double end = 0.0;       ///< time at the end of the step, s
  double duration = 0.0;  ///< of the step, s
  /// Water and fines in the pores, per volume of soil and element, kg/m3.
  std::vector<double> liquid_mass = {};
  /// n_L of each solid point at the end, with what it will have exchanged with the liquid, if it
  /// were not deformed; empty: as now.
  std::vector<double> porosity = {};
  /// Longest motion, over the height of an element there.
  double longest_travel = max_travel;
};

/// How the skeleton moves in a step.
struct SolidMotion {
  /// Whether an equilibrium was found; otherwise the step must be shorter.
  bool converged = true;
  /// Where none was found: the node at which forces are out of balance most; -1: not known.
  int worst_node = -1;
  /// Volume of soil with its pores that crosses each face along its normal, m3 (S_f). What leaves
  /// an element is what its soil grows by, V_e (J - 1), and what the bubbles of its faces carry
  /// (docs/theory.md). 0 between elements without soil.
  std::vector<double> face_volume;
  /// Volume of the solid itself that crosses each face, m3 (s_f), and what each element gains by
  /// it, m3. Empty until the motion is committed.
  std::vector<double> solid_face_volume;
  std::vector<double> solid_gain;
  int iterations = 0;   ///< of Newton's method, in the last try
  double travel = 0.0;  ///< largest displacement over the height of an element there
  /// Correction that makes s_f balance, over what the motion carries; of committed motions.
  double solid_correction = 0.0;
};

/// A step of the skeleton: what it is given, and what was found for it last. Made, solved and
/// committed by `MovingSkeleton`.
template <int Dim>
struct MotionStep {
  MotionForcing forcing;
  std::vector<double> loss;  ///< volume that each point will have lost by its end, m3; may be empty
  std::unique_ptr<StepEquilibrium<Dim>> equilibrium;  ///< holds the displacement found last
  std::unique_ptr<FaceBubbles<Dim>> bubbles;
  bool has_inertia = false;
  std::vector<double> mass;      ///< what counts for inertia, kg per point; empty without inertia
  NodalMotion<Dim> nodes;        ///< at the start of the step; empty without inertia
  std::vector<double> pressure;  ///< that it was solved for last, per element, Pa
  NodeVectors<Dim> loads;        ///< then, N
  SolidMotion motion;            ///< found then
  long iterations = 0;           ///< of Newton's method, in all tries
};

}  // namespace suffuse
