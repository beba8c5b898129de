#pragma once

/// The equilibrium of one step, to be solved repeatedly for different loads and pore pressures.

#include "equilibrium/equilibrium.hpp"
#include "equilibrium/newton.hpp"
#include "equilibrium/point_velocities.hpp"
#include "equilibrium/pseudo_time.hpp"

namespace suffuse {

template <int Dim>
class StepEquilibrium {
 public:
  /// Keeps references to grid, points and supports.
  /// \param skeleton  per point
  /// \param soft      see SolidBody
  /// \param kept      of earlier equilibria of this soil
  /// Throws NumericalError if nothing holds the soil.
  StepEquilibrium(
      const Grid<Dim>& grid, const SolidPoints<Dim>& points, std::vector<PointSkeleton> skeleton,
      const Supports<Dim>& supports, int threads, const NewtonLimits& limits = {},
      const SoftStiffness& soft = {},
      std::shared_ptr<KeptStiffness<Dim>> kept = std::make_shared<KeptStiffness<Dim>>());
  StepEquilibrium(const StepEquilibrium&) = delete;
  StepEquilibrium& operator=(const StepEquilibrium&) = delete;

  /// See `Equilibrium::set_weight`.
  void set_weight(const std::vector<Vector<Dim>>& weight) { equilibrium_.set_weight(weight); }
  /// Finds the displacement over the step, starting from the last solution. Returns false if there
  /// is none.
  /// \param loads     per node, N
  /// \param pressure  of the pores, per element, Pa; empty: none
  /// \param reduction  see `NewtonLimits`
  bool solve(const NodeVectors<Dim>& loads, std::vector<double> pressure,
             std::vector<double> stiffness = {}, double reduction = 0.0);
  /// Finds the displacement in a pseudo-time where Newton's method alone fails: in sand without
  /// cohesion.
  bool settle(const NodeVectors<Dim>& loads, std::vector<double> pressure,
              const SettlingLimits<Dim>& limits);
  /// Leaves the soil where it is. Returns the norm of the forces out of balance then, N.
  double stay(const NodeVectors<Dim>& loads, std::vector<double> pressure);
  /// Sets inertia over a step of `duration`, s; the initial guess keeps the nodes' velocities.
  void set_inertia(const NodalMotion<Dim>& nodes, double duration);
  /// Returns to the start of the step after the stress of the points has changed.
  void restart();

  /// Displacement of the last solution, m.
  [[nodiscard]] const NodeVectors<Dim>& displacement() const { return displacement_; }
  /// Increments that laws see in the last solution.
  [[nodiscard]] Increments<Dim> law_increments() const {
    return equilibrium_.law_increments(displacement_);
  }
  /// Iterations of Newton's method for the last solution.
  [[nodiscard]] int iterations() const { return iterations_; }
  /// Node with the largest unbalanced force if the last solution failed.
  [[nodiscard]] int worst_node() const { return worst_node_; }
  [[nodiscard]] const PointsByElement& sorted() const { return sorted_; }
  [[nodiscard]] const ElementClasses& classes() const { return classes_; }
  [[nodiscard]] const std::vector<PointSkeleton>& skeleton() const { return skeleton_; }
  [[nodiscard]] const Equilibrium<Dim>& equilibrium() const { return equilibrium_; }
  /// Mean effective stress of each element at the start of the step, Pa.
  [[nodiscard]] const std::vector<Eigen::Matrix<double, Dim, Dim>>& start_stress() const {
    return start_stress_;
  }

 private:
  const Grid<Dim>& grid_;
  PointsByElement sorted_;
  std::vector<PointSkeleton> skeleton_;
  ElementClasses classes_;
  Equilibrium<Dim> equilibrium_;
  EquilibriumSolver<Dim> solver_;
  NewtonLimits limits_;
  std::vector<Eigen::Matrix<double, Dim, Dim>> start_stress_;
  NodeVectors<Dim> displacement_;
  int iterations_ = 0;
  int worst_node_ = -1;
};

}  // namespace suffuse
