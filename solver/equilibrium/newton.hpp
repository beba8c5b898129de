#pragma once

/// Newton's method for the equilibrium of the solid over one step.

#include <limits>
#include <vector>

#include "equilibrium/force_balance.hpp"
#include "equilibrium/kept_stiffness.hpp"

namespace suffuse {

struct NewtonLimits {
  int max_iterations = 12;
  /// Largest residual, relative to the forces of the elements and the loads together.
  double tolerance = 1e-10;
  /// Residual below the tolerance that iterations try to reach; they stop at the first one without
  /// progress. It is for soft soil next to stiff soil: the tolerance refers to the forces of the
  /// stiff soil, which are much larger.
  double goal = std::numeric_limits<double>::infinity();
  /// The iterations may also end when the residual has fallen to this share of the first one.
  double reduction = 0.0;
};

template <int Dim>
struct NewtonSolution {
  NodeVectors<Dim> displacement;  ///< over the step, m
  /// Whether the residual fell below the tolerance. Otherwise the caller takes a shorter step.
  bool converged = false;
  /// Norm of the unbalanced forces before each iteration and at the end, relative as above.
  std::vector<double> residuals;
  int elastic_iterations = 0;  ///< of these, those with the elastic stiffness alone
  /// Node with the largest unbalanced force if the solution did not converge.
  int worst_node = -1;

  [[nodiscard]] int iterations() const { return static_cast<int>(residuals.size()) - 1; }
  [[nodiscard]] int tangents() const { return iterations() - elastic_iterations; }
};

/// Finds the displacement over a step at which the forces of the solid equal the loads. Each
/// iteration takes the largest of 1, 1/2, 1/4 ... of Newton's step that keeps volumes positive and
/// reduces the residual. Linear systems are solved by iterations with the factor of the elastic
/// stiffness, which is made at most once: further solutions, for other loads or pore pressures of
/// the same step, cost little. In equilibrium without inertia, most soil does not yield: iterations
/// begin with the elastic stiffness alone, whose factor may be that of an earlier step.
template <int Dim>
class EquilibriumSolver {
 public:
  /// Keeps a reference.
  /// \param kept  of earlier equilibria of this soil
  explicit EquilibriumSolver(
      ForceBalance<Dim>& equilibrium,
      std::shared_ptr<KeptStiffness<Dim>> kept = std::make_shared<KeptStiffness<Dim>>())
      : equilibrium_(equilibrium), kept_(std::move(kept)) {}

  /// Leaves the equilibrium displaced by the solution. Throws NumericalError if nothing holds the
  /// soil.
  /// \param loads       per node, N
  /// \param start       displacement to start from, m, which must be possible; held directions keep
  /// theirs
  NewtonSolution<Dim> solve(const NodeVectors<Dim>& loads, NodeVectors<Dim> start,
                            const NewtonLimits& limits = {});

  /// Unbalanced forces along free directions, at the last displacement: loads minus forces of the
  /// solid, N.
  [[nodiscard]] Eigen::VectorXd unbalanced(const NodeVectors<Dim>& loads) const;

 private:
  [[nodiscard]] const DisplacementUnknowns<Dim>& unknowns() const {
    return equilibrium_.unknowns();
  }
  void iterate(const NodeVectors<Dim>& loads, const NewtonLimits& limits,
               NewtonSolution<Dim>& result);
  /// Whether the next iteration tries the elastic stiffness.
  [[nodiscard]] bool is_elastic() const { return !yields_ && !equilibrium_.has_inertia(); }
  void factorise();
  void share_pattern();
  bool improve_elastically(const NodeVectors<Dim>& loads, const Eigen::VectorXd& force,
                           NodeVectors<Dim>& displacement);
  bool find_step(const Eigen::VectorXd& force, double accuracy, Eigen::VectorXd& step);
  bool improve(const NodeVectors<Dim>& loads, const Eigen::VectorXd& force, double accuracy,
               int halvings, NodeVectors<Dim>& displacement);

  ForceBalance<Dim>& equilibrium_;
  std::shared_ptr<KeptStiffness<Dim>> kept_;
  Eigen::SparseMatrix<double> matrix_;
  bool factorised_ = false;  ///< whether the factor is that of this body
  bool yields_ = false;      ///< whether the elastic stiffness has not been good enough
};

}  // namespace suffuse
