#pragma once

/// Newton's method for the equilibrium of the solid over one step.

#include <vector>

#include "deformation/equilibrium.hpp"

namespace suffuse {

struct NewtonLimits {
  int max_iterations = 12;
  /// Largest residual over the forces of the elements and the loads together.
  double tolerance = 1e-10;
};

template <int Dim>
struct NewtonSolution {
  NodeVectors<Dim> displacement;  ///< over the step, m
  /// Whether the residual fell below the tolerance. Else the caller takes a shorter step.
  bool converged = false;
  /// Norm of the forces out of balance before each iteration and at the end, relative as above.
  std::vector<double> residuals;

  [[nodiscard]] int iterations() const { return static_cast<int>(residuals.size()) - 1; }
};

/// Finds the displacement over a step at which the forces of the solid equal the loads. Each
/// iteration takes as much of Newton's step, by halves, as leaves every element a volume and the
/// residual smaller. The linear systems are solved by iterations with the factor of the elastic
/// stiffness, which is made once.
/// \param loads       per node, N
/// \param prescribed  displacement over the step in directions that are held, m; empty: none. What
///                    it says about free directions is not used.
/// Leaves `equilibrium` displaced by the solution. Throws NumericalError when nothing holds the
/// soil.
template <int Dim>
NewtonSolution<Dim> solve_equilibrium(Equilibrium<Dim>& equilibrium, const NodeVectors<Dim>& loads,
                                      const NodeVectors<Dim>& prescribed,
                                      const NewtonLimits& limits = {});

}  // namespace suffuse
