#pragma once

/// The motion of a skeleton over one step, to be tried. The skeleton does not change before it
/// commits the step.

#include <memory>
#include <vector>

#include "motion/motion_flux.hpp"

namespace suffuse {

/// A motion by more than this share of an element's height counts as no solution: points could skip
/// elements.
inline constexpr double max_travel = 0.5;

/// Input of a step of the skeleton, except pressures.
struct MotionForcing {
  double end = 0.0;       ///< time at the end of the step, s
  double duration = 0.0;  ///< of the step, s
  /// Water and fines in the pores, per volume of soil and element, kg/m3.
  std::vector<double> liquid_mass = {};
  /// n_L of each solid point at the end, after its exchange with the liquid but without
  /// deformation; empty: as now.
  std::vector<double> porosity = {};
  /// Longest motion, over the height of an element there.
  double longest_travel = max_travel;
};

/// How the skeleton moves in a step.
struct SolidMotion {
  /// Whether an equilibrium with a motion that is not too long was found; if not, shorten the step.
  bool converged = true;
  /// Without an equilibrium: node with the largest residual of forces; -1: not known.
  int worst_node = -1;
  /// Volume of soil with its pores that crosses each face along its normal, m3 (S_f). The outflow
  /// of an element is the growth of its soil, V_e (J - 1), plus the volumes of the bubbles of its
  /// faces (docs/theory/moving-soil.md). 0 between elements without soil.
  std::vector<double> face_volume;
  /// Volume of the solid itself that crosses each face, m3 (s_f), and the gain of each element by
  /// it, m3. Empty until the motion is committed.
  std::vector<double> solid_face_volume;
  std::vector<double> solid_gain;
  int iterations = 0;   ///< of Newton's method, in the last attempt
  double travel = 0.0;  ///< largest displacement over the height of an element there
  /// Correction that makes s_f balance, over what the motion carries; of committed motions.
  double solid_correction = 0.0;
};

/// A step of the skeleton: its input, and its last solution. `MovingSkeleton` makes, solves and
/// commits it.
template <int Dim>
struct MotionStep {
  MotionForcing forcing;
  std::vector<double> loss;  ///< volume that each point loses in the step, m3; may be empty
  std::unique_ptr<StepEquilibrium<Dim>> equilibrium;  ///< holds the displacement found last
  std::unique_ptr<FaceBubbles<Dim>> bubbles;
  bool has_inertia = false;
  bool stays = false;            ///< the soil stays where it is
  double reduction = 0.0;        ///< of residuals in the next solution: see `NewtonLimits`
  std::vector<double> mass;      ///< that has inertia, kg per point; empty without inertia
  NodalMotion<Dim> nodes;        ///< at the start of the step; empty without inertia
  std::vector<double> pressure;  ///< of the last solution, per element, Pa
  NodeVectors<Dim> loads;        ///< of the last solution, with crossing forces, N
  SolidMotion motion;            ///< the last solution
  long iterations = 0;           ///< of Newton's method, in all attempts
};

}  // namespace suffuse
