#pragma once

/// The factor of safety of a body of soil: by how much its strength can be divided before no
/// equilibrium is left (Zienkiewicz, Humpheson and Lewis, Geotechnique 25 (1975) 671; Griffiths and
/// Lane, Geotechnique 49 (1999) 387).

#include <vector>

#include "equilibrium/newton.hpp"

namespace suffuse {

struct StrengthReductionLimits {
  /// Relative distance of the smallest factor that fails from the largest that holds.
  double tolerance = 0.01;
  /// Factors outside are not looked for.
  double least = 1.0 / 64.0;
  double largest = 64.0;
  /// Displacements above this multiple of those of the elastic body have run away.
  double runaway = 200.0;
  /// Residuals are relative to forces at a strain of `Equilibrium::least_strain` at least, which
  /// are up to a thousand times those of the stiff soil of the trials: thus the tolerance.
  NewtonLimits newton{.max_iterations = 60, .tolerance = 1e-9};
  /// Iterations of a trial in pseudo-time, after those of Newton's method.
  int settling_iterations = 600;
  /// After so many trials that decide nothing the search is given up.
  int most_undecided = 3;
};

/// How a trial ended. Iterations that ran out decide nothing: soil that Newton's method finds no
/// equilibrium of is not for that reason soil that fails.
enum class TrialEnd {
  holds,     ///< forces balance
  fails,     ///< displacements ran away
  undecided  ///< neither
};

struct StrengthTrial {
  double factor = 0.0;
  TrialEnd end = TrialEnd::undecided;
  /// Under the loads from no stress, m; without equilibrium that at the end of the trial.
  double displacement_max = 0.0;
  double residual = 0.0;  ///< forces out of balance at the end, over all forces
  int iterations = 0;     ///< of Newton's method
};

struct SafetyFactor {
  /// Between the two below, their geometric mean; 0 or infinite where one of them is.
  double factor = 0.0;
  double holds = 0.0;                 ///< largest that was tried and holds; 0: none does
  double fails = 0.0;                 ///< smallest that fails; infinite: none does
  std::vector<StrengthTrial> trials;  ///< in the order in which they were made
  /// Displacement of the nodes at last, in the trial of the smallest factor that fails, m: its
  /// directions and shares show how the soil fails, its size means nothing. Dim values per node;
  /// empty where no trial failed.
  std::vector<double> mechanism;
  /// Where forces are out of balance most in the last trial, which is undecided, as some before:
  /// there is no factor then. -1: there is.
  int undecided_node = -1;
};

/// tan phi and c over the factor; the angle of dilation at most that of friction.
[[nodiscard]] SkeletonParameters reduced_strength(const SkeletonParameters& parameters,
                                                  double factor);

/// Looks for the factor by bisection, in the logarithm. Each trial loads the body from no stress in
/// one increment: what a perfectly plastic body can carry does not depend on the stress before.
/// Newton's method starts at the displacement of the largest factor that holds. Where it finds no
/// equilibrium, `PseudoTime` goes on from there until the soil rests or runs away. Where it does
/// neither, as next to the limit, the search goes on above that factor and below, and gives up
/// after a few.
///
/// The factor does not depend on Young's modulus either. The trials multiply it by one number in
/// all of the soil, so that its shape stays. Displacements are those of the soil as it is, to first
/// order.
///
/// \param body      stresses and `plastic_strain` of its points are not used
/// \param loads     per node, N
/// \param pressure  pore pressure per element, Pa; empty: none
///
/// Throws NumericalError when nothing holds the soil.
template <int Dim>
SafetyFactor find_safety_factor(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                                const NodeVectors<Dim>& loads, const std::vector<double>& pressure,
                                int threads, const StrengthReductionLimits& limits = {});

}  // namespace suffuse
