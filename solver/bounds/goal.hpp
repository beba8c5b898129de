#pragma once

/// A number that follows from a flow and is linear in its heads, such as a discharge or a mean
/// head: how far it can be off, by its dual.

#include "bounds/interval.hpp"
#include "bounds/seepage_problem.hpp"

namespace suffuse {

/// The number as the fields of the flow give it.
struct Goal {
  double of_heads = 0.0;   ///< by the continuous head
  double of_fluxes = 0.0;  ///< by the fluxes that balance
  double in_time = 0.0;    ///< by the errors of the last step in time
};

/// The number is the mean of the two ways to correct it by its dual, off by half the integral of
/// gap . K (e + d), with e and d the errors of the dual's fields, whose difference is the dual's
/// gap. By Cauchy and Schwarz, that is half the product of the two gaps' norms at most. For a
/// discharge, m3/s; wider for round-off.
template <int Dim>
Interval bound(const SeepageProblem<Dim>& problem, const Goal& goal, const FieldPair<Dim>& dual);

/// Takes the errors of the dual's fields to be where its gap is: half the sum of the products of
/// both gaps' norms in each element. No bound, but much narrower where the two gaps lie apart.
template <int Dim>
Interval estimate(const SeepageProblem<Dim>& problem, const Goal& goal, const FieldPair<Dim>& dual);

/// Errors of the last step. A conductivity that is off by dK changes the number by the integral of
/// grad h . dK grad h*, with h* the dual's head.
template <int Dim>
StepEstimates step_estimates(const SeepageProblem<Dim>& problem, const Goal& goal,
                             const FieldPair<Dim>& dual);

/// Widening of a discharge's interval for round-off, m3/s.
template <int Dim>
double margin_of(const SeepageProblem<Dim>& problem);

/// Norm of slopes that belongs to the energy.
template <int Dim>
double norm(const SeepageEnergy<Dim>& energy, const Slopes<Dim>& slopes);

}  // namespace suffuse
