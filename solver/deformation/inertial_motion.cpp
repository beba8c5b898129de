#include "deformation/inertial_motion.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "deformation/point_motion.hpp"

namespace suffuse {
namespace {

template <int Dim>
NodeVectors<Dim> times(double factor, NodeVectors<Dim> vectors) {
  for (Vector<Dim>& v : vectors) v *= factor;
  return vectors;
}

template <int Dim>
double norm(const NodeVectors<Dim>& vectors) {
  double sum = 0.0;
  for (const Vector<Dim>& v : vectors) sum += v.squaredNorm();
  return std::sqrt(sum);
}

/// The displacement of nodes that go on as they go, where nothing holds them.
template <int Dim>
NodeVectors<Dim> coasting(const DisplacementUnknowns<Dim>& unknowns, const NodalMotion<Dim>& nodes,
                          double dt) {
  NodeVectors<Dim> result(nodes.velocity.size(), Vector<Dim>::Zero());
  unknowns.add(unknowns.components(nodes.velocity), dt, result);
  return result;
}

[[noreturn]] void refuse(double shortest) {
  std::ostringstream message;
  message << "the motion of the soil has no solution, not even in a step of " << shortest
          << " s; give the soil less stiffness, or the mesh larger elements";
  throw NumericalError(message.str());
}

}  // namespace

template <int Dim>
double InertialMotion<Dim>::first_try(const PointsByElement& sorted, const NodalMotion<Dim>& nodes,
                                      double longest) const {
  const double travel = largest_travel(grid_, sorted, nodes.velocity);  // per second
  double dt = next_ > 0.0 ? std::min(next_, longest) : longest;
  if (travel * dt > limits_.max_travel) dt = limits_.max_travel / travel;
  return dt;
}

template <int Dim>
void InertialMotion<Dim>::plan_next(const InertialStep& step) {
  next_ = step.duration;
  if (step.iterations > limits_.many_iterations) next_ *= 0.7;
  if (step.tries == 1 && step.iterations <= limits_.many_iterations / 2) next_ *= limits_.growth;
}

template <int Dim>
InertialStep InertialMotion<Dim>::step(SolidPoints<Dim>& points,
                                       const std::vector<PointSkeleton>& skeleton,
                                       const std::vector<double>& mass,
                                       const NodeVectors<Dim>& loads, double longest) {
  const PointsByElement sorted(grid_.mesh.element_count(), points.element);
  const ElementClasses classes(grid_, points, sorted);
  const NodalMotion<Dim> nodes = velocities_.to_nodes(grid_, points, mass);
  // Inertia holds a piece of soil that hangs by one node.
  Equilibrium<Dim> equilibrium({grid_, points, sorted, skeleton, classes, 0.0}, supports_,
                               threads_);
  InertialStep result{.duration = first_try(sorted, nodes, longest)};
  for (;; result.duration *= 0.5) {
    const double dt = result.duration;
    if (dt < limits_.shortest) refuse(limits_.shortest);
    ++result.tries;
    equilibrium.set_inertia(nodes.mass, nodes.velocity, dt);
    NodeVectors<Dim> start = coasting(equilibrium.unknowns(), nodes, dt);
    if (!equilibrium.is_possible(start)) continue;
    EquilibriumSolver<Dim> solver(equilibrium);
    const NewtonSolution<Dim> solution = solver.solve(loads, std::move(start), limits_.newton);
    if (!solution.converged) continue;
    if (largest_travel(grid_, sorted, solution.displacement) > 1.5 * limits_.max_travel) continue;
    result.iterations = solution.iterations();
    result.inertia_share = equilibrium.inertia_norm() / norm<Dim>(loads);
    velocities_.take(grid_, points, times<Dim>(1.0 / dt, solution.displacement), nodes.mass);
    move_points(grid_, skeleton, solution.displacement, points, threads_);
    plan_next(result);
    return result;
  }
}

bool is_at_rest(const InertialStep& step, double kinetic_energy, double weight, double height) {
  constexpr double small_share = 1e-2;
  constexpr double small_energy = 1e-6;
  return step.inertia_share < small_share && kinetic_energy < small_energy * weight * height;
}

template class InertialMotion<2>;
template class InertialMotion<3>;

}  // namespace suffuse
