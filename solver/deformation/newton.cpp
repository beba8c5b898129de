#include "deformation/newton.hpp"

#include <cmath>

#include "linear/newton_system.hpp"

namespace suffuse {
namespace {

/// So often Newton's step is halved before the iterations are given up.
constexpr int max_halvings = 10;
/// The residual must fall by this share of what the linear model promises (Armijo's rule).
constexpr double enough = 1e-4;
template <int Dim>
double norm(const NodeVectors<Dim>& vectors) {
  double sum = 0.0;
  for (const Vector<Dim>& v : vectors) sum += v.squaredNorm();
  return std::sqrt(sum);
}

/// One solution: the displacement so far, and what is out of balance.
template <int Dim>
class NewtonIterations {
 public:
  NewtonIterations(Equilibrium<Dim>& equilibrium, const NodeVectors<Dim>& loads)
      : equilibrium_(equilibrium), loads_(loads) {
    equilibrium.assemble_elastic(matrix_);
    if (unknowns().count() == 0) return;
    try {
      system_.factorise(matrix_);
    } catch (const NumericalError&) {
      throw NumericalError(
          "the displacements could not be solved for: nothing holds the soil, or a piece of it; "
          "fix "
          "a boundary that it lies on");
    }
  }

  NewtonSolution<Dim> solve(const NodeVectors<Dim>& prescribed, const NewtonLimits& limits) {
    NewtonSolution<Dim> result;
    result.displacement.assign(loads_.size(), Vector<Dim>::Zero());
    NodeVectors<Dim>& displacement = result.displacement;
    equilibrium_.displace(displacement, true);
    if (!prescribed.empty() && !prescribe(prescribed, displacement)) return result;
    measure(result);
    while (!(result.residuals.back() <= limits.tolerance)) {
      if (result.iterations() == limits.max_iterations || !improve(displacement)) return result;
      measure(result);
    }
    result.converged = true;
    return result;
  }

 private:
  [[nodiscard]] const DisplacementUnknowns<Dim>& unknowns() const {
    return equilibrium_.unknowns();
  }

  /// Norm of a force over all there are.
  [[nodiscard]] double relative(double force) const {
    return force / (equilibrium_.force_scale() + norm<Dim>(loads_));
  }

  /// The forces that balance, along free directions: what the loads leave to be carried.
  [[nodiscard]] Eigen::VectorXd unbalanced() const {
    return unknowns().components(loads_) - unknowns().components(equilibrium_.forces());
  }

  void measure(NewtonSolution<Dim>& result) {
    unbalanced_ = unbalanced();
    result.residuals.push_back(relative(unbalanced_.norm()));
  }

  /// Newton's step for these forces; false where the tangent is singular: what the soil can carry
  /// has been reached.
  bool find_step(const Eigen::VectorXd& force, Eigen::VectorXd& step) {
    step = Eigen::VectorXd::Zero(force.size());
    if (force.size() == 0) return true;
    equilibrium_.assemble(matrix_);
    try {
      system_.solve(matrix_, force, step);
    } catch (const NumericalError&) {
      return false;
    }
    return true;
  }

  /// Goes where the linear model at the start has the nodes that are held, and the others with
  /// them: to move the held ones alone would turn their elements inside out. Returns false where
  /// an element would lose its volume.
  bool prescribe(const NodeVectors<Dim>& prescribed, NodeVectors<Dim>& displacement) {
    displacement = prescribed;
    unknowns().add(unknowns().components(prescribed), -1.0, displacement);
    const Eigen::VectorXd force =
        unbalanced() - unknowns().components(equilibrium_.tangent_times(displacement));
    Eigen::VectorXd step;
    if (!find_step(force, step)) return false;
    unknowns().add(step, 1.0, displacement);
    if (!equilibrium_.is_possible(displacement)) return false;
    equilibrium_.displace(displacement, true);
    return true;
  }

  /// One iteration. Returns false where no part of the step makes the residual smaller.
  bool improve(NodeVectors<Dim>& displacement) {
    Eigen::VectorXd step;
    if (!find_step(unbalanced_, step)) return false;
    const double before = unbalanced_.norm();
    double share = 1.0;
    for (int halving = 0; halving <= max_halvings; ++halving, share *= 0.5) {
      NodeVectors<Dim> trial = displacement;
      unknowns().add(step, share, trial);
      if (!equilibrium_.is_possible(trial)) continue;
      equilibrium_.displace(trial, true);
      if (!(unbalanced().norm() <= (1.0 - enough * share) * before)) continue;
      displacement = std::move(trial);
      return true;
    }
    equilibrium_.displace(displacement, true);
    return false;
  }

  Equilibrium<Dim>& equilibrium_;
  const NodeVectors<Dim>& loads_;
  NewtonSystem system_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd unbalanced_;
};

}  // namespace

template <int Dim>
NewtonSolution<Dim> solve_equilibrium(Equilibrium<Dim>& equilibrium, const NodeVectors<Dim>& loads,
                                      const NodeVectors<Dim>& prescribed,
                                      const NewtonLimits& limits) {
  return NewtonIterations<Dim>(equilibrium, loads).solve(prescribed, limits);
}

template NewtonSolution<2> solve_equilibrium(Equilibrium<2>&, const NodeVectors<2>&,
                                             const NodeVectors<2>&, const NewtonLimits&);
template NewtonSolution<3> solve_equilibrium(Equilibrium<3>&, const NodeVectors<3>&,
                                             const NodeVectors<3>&, const NewtonLimits&);

}  // namespace suffuse
