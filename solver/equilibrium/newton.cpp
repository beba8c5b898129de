#include "equilibrium/newton.hpp"

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"

namespace suffuse {
namespace {

/// Most halvings of Newton's step before the iterations are given up.
constexpr int max_halvings = 10;
/// The residual must fall by this share of the linear model's prediction (Armijo's rule).
constexpr double enough = 1e-4;
/// Smallest tolerance of a linear solution, relative to its right-hand side.
constexpr double best_accuracy = 1e-9;
/// Share of the residual that an iteration with the elastic stiffness may leave.
constexpr double elastic_reduction = 0.03;
constexpr int max_elastic_iterations = 20;

/// Tolerance of the linear solution, relative to its right-hand side: no smaller than Newton's
/// method can use or the tolerance needs.
double accuracy_at(double residual, double tolerance) {
  return std::clamp(std::max(0.1 * tolerance / residual, 0.01 * residual), best_accuracy, 1e-3);
}

}  // namespace

template <int Dim>
NewtonSolution<Dim> EquilibriumSolver<Dim>::solve(const NodeVectors<Dim>& loads,
                                                  NodeVectors<Dim> start,
                                                  const NewtonLimits& limits) {
  NewtonSolution<Dim> result;
  result.displacement = std::move(start);
  kept_->system.iterate_again();
  equilibrium_.displace(result.displacement, !is_elastic());
  iterate(loads, limits, result);
  if (!result.converged) result.worst_node = unknowns().longest(unbalanced(loads));
  return result;
}

template <int Dim>
void EquilibriumSolver<Dim>::iterate(const NodeVectors<Dim>& loads, const NewtonLimits& limits,
                                     NewtonSolution<Dim>& result) {
  for (;;) {
    const Eigen::VectorXd force = unbalanced(loads);
    const double residual = force.norm() / (equilibrium_.force_scale() + norm<Dim>(loads));
    result.residuals.push_back(residual);
    const double reduced = limits.reduction * result.residuals.front();
    const double goal = std::max(std::min(limits.goal, limits.tolerance), reduced);
    result.converged = residual <= std::max(limits.tolerance, reduced);
    if (residual <= goal || result.tangents() == limits.max_iterations) return;
    if (is_elastic() && result.elastic_iterations < max_elastic_iterations) {
      if (improve_elastically(loads, force, result.displacement)) {
        ++result.elastic_iterations;
        continue;
      }
      yields_ = true;
    }
    const double accuracy = accuracy_at(residual, goal);
    const int halvings = result.converged ? 0 : max_halvings;
    if (!improve(loads, force, accuracy, halvings, result.displacement)) return;
  }
}

template <int Dim>
Eigen::VectorXd EquilibriumSolver<Dim>::unbalanced(const NodeVectors<Dim>& loads) const {
  return unknowns().components(loads) - unknowns().components(equilibrium_.forces());
}

/// Drops what was kept if another body has another pattern.
template <int Dim>
void EquilibriumSolver<Dim>::share_pattern() {
  if (!equilibrium_.share_pattern(kept_->pattern)) kept_->system = NewtonSystem();
}

/// Factorizes once, for the first system that the kept factor does not solve: a step without any
/// change needs no factor.
template <int Dim>
void EquilibriumSolver<Dim>::factorise() {
  if (factorised_) return;
  share_pattern();
  equilibrium_.assemble_elastic(matrix_);
  try {
    kept_->system.factorise(matrix_);
  } catch (const NumericalError&) {
    throw NumericalError(
        "the displacements could not be solved for: nothing holds the soil, or a piece of it; fix "
        "a boundary that it lies on");
  }
  factorised_ = true;
}

/// Finds Newton's step for these forces; false if the tangent is singular, as at a limit load.
template <int Dim>
bool EquilibriumSolver<Dim>::find_step(const Eigen::VectorXd& force, double accuracy,
                                       Eigen::VectorXd& step) {
  step = Eigen::VectorXd::Zero(force.size());
  if (force.size() == 0) return true;
  factorise();
  equilibrium_.find_tangents();
  equilibrium_.assemble(matrix_);
  try {
    kept_->system.solve(matrix_, force, step, accuracy);
  } catch (const NumericalError&) {
    return false;
  }
  return true;
}

/// One iteration with the elastic stiffness, first with the kept one. Returns false, and changes
/// nothing, if it reduces the residual too little.
template <int Dim>
bool EquilibriumSolver<Dim>::improve_elastically(const NodeVectors<Dim>& loads,
                                                 const Eigen::VectorXd& force,
                                                 NodeVectors<Dim>& displacement) {
  if (force.size() == 0) return false;
  share_pattern();
  for (;;) {
    if (!kept_->system.is_factored()) factorise();
    Eigen::VectorXd step;
    kept_->system.solve_nearly(force, step);
    NodeVectors<Dim> trial = displacement;
    unknowns().add(step, 1.0, trial);
    if (equilibrium_.is_possible(trial)) {
      equilibrium_.displace(trial, false);
      if (unbalanced(loads).norm() <= elastic_reduction * force.norm()) {
        displacement = std::move(trial);
        return true;
      }
    }
    equilibrium_.displace(displacement, false);
    if (factorised_) return false;
    factorise();
  }
}

/// One iteration. Returns false if no part of the step reduces the residual.
template <int Dim>
bool EquilibriumSolver<Dim>::improve(const NodeVectors<Dim>& loads, const Eigen::VectorXd& force,
                                     double accuracy, int halvings,
                                     NodeVectors<Dim>& displacement) {
  Eigen::VectorXd step;
  if (!find_step(force, accuracy, step)) return false;
  const double before = force.norm();
  double share = 1.0;
  for (int halving = 0; halving <= halvings; ++halving, share *= 0.5) {
    NodeVectors<Dim> trial = displacement;
    unknowns().add(step, share, trial);
    if (!equilibrium_.is_possible(trial)) continue;
    equilibrium_.displace(trial, true);
    if (!(unbalanced(loads).norm() <= (1.0 - enough * share) * before)) continue;
    displacement = std::move(trial);
    return true;
  }
  equilibrium_.displace(displacement, true);
  return false;
}

template class EquilibriumSolver<2>;
template class EquilibriumSolver<3>;

}  // namespace suffuse
