#include "equilibrium/step_equilibrium.hpp"

namespace suffuse {

template <int Dim>
StepEquilibrium<Dim>::StepEquilibrium(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                      std::vector<PointSkeleton> skeleton,
                                      const Supports<Dim>& supports, int threads,
                                      const NewtonLimits& limits, const SoftStiffness& soft,
                                      std::shared_ptr<KeptStiffness<Dim>> kept)
    : grid_(grid),
      sorted_(grid.mesh.element_count(), points.element),
      skeleton_(std::move(skeleton)),
      classes_(grid, points, sorted_),
      equilibrium_({grid, points, sorted_, skeleton_, classes_, soft}, supports, threads),
      solver_(equilibrium_, std::move(kept)),
      limits_(limits) {
  restart();
}

template <int Dim>
void StepEquilibrium<Dim>::set_inertia(const NodalMotion<Dim>& nodes, double duration) {
  equilibrium_.set_inertia(nodes.mass, nodes.velocity, duration);
  const DisplacementUnknowns<Dim>& unknowns = equilibrium_.unknowns();
  NodeVectors<Dim> coasting(nodes.velocity.size(), Vector<Dim>::Zero());
  unknowns.add(unknowns.components(nodes.velocity), duration, coasting);
  if (equilibrium_.is_possible(coasting)) displacement_ = std::move(coasting);
}

template <int Dim>
void StepEquilibrium<Dim>::restart() {
  displacement_.assign(grid_.mesh.node_count(), Vector<Dim>::Zero());
  equilibrium_.forget_displacement();
  equilibrium_.displace(displacement_, false);
  start_stress_.assign(grid_.mesh.element_count(), Eigen::Matrix<double, Dim, Dim>::Zero());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (!sorted_.is_empty(e)) start_stress_[e] = equilibrium_.mean_stress(e);
  }
}

template <int Dim>
bool StepEquilibrium<Dim>::solve(const NodeVectors<Dim>& loads, std::vector<double> pressure,
                                 std::vector<double> stiffness, double reduction) {
  limits_.reduction = reduction;
  equilibrium_.set_pressure(std::move(pressure), std::move(stiffness));
  NewtonSolution<Dim> solution = solver_.solve(loads, displacement_, limits_);
  if (!solution.converged) {
    const NodeVectors<Dim> rest(displacement_.size(), Vector<Dim>::Zero());
    solution = solver_.solve(loads, rest, limits_);
  }
  iterations_ = solution.iterations();
  if (!solution.converged) worst_node_ = solution.worst_node;
  if (solution.converged) displacement_ = std::move(solution.displacement);
  return solution.converged;
}

template <int Dim>
double StepEquilibrium<Dim>::stay(const NodeVectors<Dim>& loads, std::vector<double> pressure) {
  equilibrium_.set_pressure(std::move(pressure));
  displacement_.assign(loads.size(), Vector<Dim>::Zero());
  equilibrium_.displace(displacement_, false);
  iterations_ = 0;
  return solver_.unbalanced(loads).norm();
}

template <int Dim>
bool StepEquilibrium<Dim>::settle(const NodeVectors<Dim>& loads, std::vector<double> pressure,
                                  const SettlingLimits<Dim>& limits) {
  equilibrium_.set_pressure(std::move(pressure));
  SettledSoil<Dim> soil =
      PseudoTime<Dim>(equilibrium_, loads)
          .settle(NodeVectors<Dim>(displacement_.size(), Vector<Dim>::Zero()), limits);
  iterations_ = soil.iterations;
  const bool rests = soil.end == Settling::rests;
  if (!rests) worst_node_ = soil.worst_node;
  if (rests) displacement_ = std::move(soil.displacement);
  return rests;
}

template class StepEquilibrium<2>;
template class StepEquilibrium<3>;

}  // namespace suffuse
