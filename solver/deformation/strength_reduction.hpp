#pragma once

/// The factor of safety of a body of soil: by how much its strength can be divided before no
/// equilibrium is left (Zienkiewicz, Humpheson and Lewis, Geotechnique 25 (1975) 671; Griffiths and
/// Lane, Geotechnique 49 (1999) 387).

#include <vector>

#include "deformation/newton.hpp"

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
};

struct StrengthTrial {
  double factor = 0.0;
  bool converged = false;  ///< equilibrium was found
  bool holds = false;      ///< and displacements did not run away
  /// Under the loads from no stress, m; without equilibrium that of the last iteration.
  double displacement_max = 0.0;
  int iterations = 0;
};

struct SafetyFactor {
  /// Between the two below, their geometric mean; 0 or infinite where one of them is.
  double factor = 0.0;
  double holds = 0.0;                 ///< largest that was tried and holds; 0: none does
  double fails = 0.0;                 ///< smallest that fails; infinite: none does
  std::vector<StrengthTrial> trials;  ///< in the order in which they were made
  /// Displacement of the nodes in the trial of the smallest factor that fails, when it was given
  /// up, beyond that of the elastic body, m: its directions and shares show how the soil fails, its
  /// size means nothing. Dim values per node; empty where no trial failed.
  std::vector<double> mechanism;
};

/// tan phi and c over the factor; the angle of dilation at most that of friction.
[[nodiscard]] SkeletonParameters reduced_strength(const SkeletonParameters& parameters,
                                                  double factor);

/// Looks for the factor by bisection, in the logarithm. Each trial loads the body from no stress in
/// one increment: what a perfectly plastic body can carry does not depend on the stress before.
/// Newton's method starts at the displacement of the largest factor that holds; that a factor fails
/// is believed when it has failed from the one below it and from no displacement too.
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
