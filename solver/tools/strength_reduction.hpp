#pragma once

/// The factor of safety of a body of soil: the largest divisor of its strength for which it has an
/// equilibrium (Zienkiewicz, Humpheson and Lewis, Geotechnique 25 (1975) 671; Griffiths and Lane,
/// Geotechnique 49 (1999) 387).

#include <vector>

#include "boundary/nodal_loads.hpp"
#include "equilibrium/equilibrium.hpp"
#include "equilibrium/newton.hpp"
#include "equilibrium/pseudo_time.hpp"

namespace suffuse {

struct StrengthReductionLimits {
  /// Relative distance of the smallest factor that fails from the largest that holds.
  double tolerance = 0.01;
  /// Smallest and largest factor of the search.
  double least = 1.0 / 64.0;
  double largest = 64.0;
  /// Displacements in a trial above this multiple of the elastic ones mean failure.
  double runaway = 200.0;
  /// The tolerance is small, because residuals are relative to forces at a larger strain than that
  /// of trials. If it would accept forces of 1 % of an element's weight, a trial takes a smaller
  /// one.
  NewtonLimits newton{.max_iterations = 60, .tolerance = 1e-9};
  /// Iterations of a trial in pseudo-time, after those of Newton's method.
  int settling_iterations = 600;
  /// The search is given up after this number of undecided trials.
  int most_undecided = 3;
};

struct StrengthTrial {
  double factor = 0.0;
  Settling end = Settling::undecided;
  /// Largest displacement from zero stress, in equilibrium or at the end of the trial, m.
  double displacement_max = 0.0;
  double residual = 0.0;  ///< forces out of balance at the end, over all forces
  int iterations = 0;     ///< of Newton's method
};

struct SafetyFactor {
  /// Geometric mean of the two below; 0 or infinite if one of them is.
  double factor = 0.0;
  double holds = 0.0;                 ///< largest tried factor that holds; 0: none
  double fails = 0.0;                 ///< smallest tried factor that fails; infinite: none
  std::vector<StrengthTrial> trials;  ///< in their order
  /// Last displacement of the nodes in the trial of the smallest factor that fails, m: it shows the
  /// mechanism of failure, but its size has no meaning. Dim values per node; empty if no trial
  /// failed.
  std::vector<double> mechanism;
  /// If there is no factor because trials are undecided: node with the largest unbalanced force in
  /// the last one. Otherwise -1.
  int undecided_node = -1;
};

/// Divides tan phi and c by the factor; limits the angle of dilation to that of friction.
[[nodiscard]] SkeletonParameters reduced_strength(const SkeletonParameters& parameters,
                                                  double factor);

/// Finds the factor by bisection of its logarithm. Each trial loads the body from zero stress in
/// one increment, because the limit load of a perfectly plastic body does not depend on earlier
/// stress. Newton's method starts at the displacement of the largest factor that holds. If it finds
/// no equilibrium, `PseudoTime` continues from this displacement until the soil rests or runs away.
/// If it does neither, as near the limit, the search continues above and below this factor, and is
/// given up after a few such trials.
///
/// The factor does not depend on Young's modulus either: all soil has the same one in trials. The
/// motion of a trial is compared with the elastic displacement under the loads of the soil that
/// moves, because the loads of deep ground cause a much larger one. Displacements are scaled to
/// those of soil with the mean modulus, to first order.
///
/// \param body      stresses and `plastic_strain` of its points are not used
/// \param loads     N; trials have linear or quadratic displacements as the loads have
/// \param pressure  pore pressure per element, Pa; empty: none
/// \param kept_cohesion  per point: additional cohesion that is not divided, Pa; empty: none
///
/// Throws NumericalError when nothing holds the soil.
template <int Dim>
SafetyFactor find_safety_factor(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                                const NodalLoads<Dim>& loads, const std::vector<double>& pressure,
                                int threads, const StrengthReductionLimits& limits = {},
                                const std::vector<double>& kept_cohesion = {});

}  // namespace suffuse
