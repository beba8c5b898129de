#pragma once

/// Steps of dry soil with inertia and without flow, made with parts of the solver.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "equilibrium/newton.hpp"
#include "equilibrium/point_velocities.hpp"
#include "motion/point_motion.hpp"
#include "motion/point_spacing.hpp"

namespace suffuse::model {

struct InertialLimits {
  double max_travel = 0.25;  ///< of a point in a step, relative to the height of its element
  double growth = 1.5;       ///< of a step, relative to the one before
  /// A step with more iterations of Newton's method makes the next one shorter; one with at most
  /// half as many lets it grow.
  int many_iterations = 8;
  double shortest = 1e-7;  ///< s; no step is tried below this
  NewtonLimits newton = {.max_iterations = 12, .tolerance = 1e-5};
};

/// Results of a step.
struct InertialStep {
  double duration = 0.0;  ///< s
  int iterations = 0;     ///< of Newton's method
  int tries = 0;
  /// Forces of inertia over the loads: near 0 the soil is in equilibrium.
  double inertia_share = 0.0;
};

template <int Dim>
class InertialMotion {
 public:
  /// Starts with points at rest. Keeps references to grid and supports.
  InertialMotion(const Grid<Dim>& grid, const Supports<Dim>& supports, int point_count, int threads,
                 const InertialLimits& limits = {})
      : grid_(grid),
        supports_(supports),
        threads_(threads),
        limits_(limits),
        velocities_(point_count) {}

  [[nodiscard]] PointVelocities<Dim>& velocities() { return velocities_; }
  [[nodiscard]] const PointVelocities<Dim>& velocities() const { return velocities_; }
  /// Rate of shear sqrt(2 D:D) of each point in the last step, with the deviator D of the rate of
  /// deformation, 1/s; empty before the first.
  [[nodiscard]] const std::vector<double>& shear_rate() const { return shear_rate_; }

  /// Moves the points by one step of at most `longest` seconds. Throws NumericalError if no step is
  /// short enough, or if a point leaves the mesh.
  /// \param skeleton  per point
  /// \param mass      per point, kg
  /// \param loads     per node, N: the weight of the points among them
  InertialStep step(SolidPoints<Dim>& points, const std::vector<PointSkeleton>& skeleton,
                    const std::vector<double>& mass, const NodeVectors<Dim>& loads, double longest);

  void archive(auto& archive) { archive(velocities_, next_); }

 private:
  [[nodiscard]] double first_try(const SolidPoints<Dim>& points, const NodalMotion<Dim>& nodes,
                                 double longest) const;
  void plan_next(const InertialStep& step);
  void find_shear_rates(const Increments<Dim>& increments, const SolidPoints<Dim>& points,
                        double dt);

  const Grid<Dim>& grid_;
  const Supports<Dim>& supports_;
  int threads_;
  InertialLimits limits_;
  PointVelocities<Dim> velocities_;
  std::vector<double> shear_rate_;
  double next_ = 0.0;  ///< length of the next step, s; 0: not known
};

template <int Dim>
NodeVectors<Dim> times(double factor, NodeVectors<Dim> vectors) {
  for (Vector<Dim>& v : vectors) v *= factor;
  return vectors;
}

/// The displacement of free nodes that keep their velocity.
template <int Dim>
NodeVectors<Dim> coasting(const DisplacementUnknowns<Dim>& unknowns, const NodalMotion<Dim>& nodes,
                          double dt) {
  NodeVectors<Dim> result(nodes.velocity.size(), Vector<Dim>::Zero());
  unknowns.add(unknowns.components(nodes.velocity), dt, result);
  return result;
}

[[noreturn]] inline void refuse(double shortest) {
  std::ostringstream message;
  message << "the motion of the soil has no solution, not even in a step of " << shortest
          << " s; give the soil less stiffness, or the mesh larger elements";
  throw NumericalError(message.str());
}

template <int Dim>
double InertialMotion<Dim>::first_try(const SolidPoints<Dim>& points, const NodalMotion<Dim>& nodes,
                                      double longest) const {
  const double travel = largest_travel(grid_, points, nodes.velocity);  // per second
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
void InertialMotion<Dim>::find_shear_rates(const Increments<Dim>& increments,
                                           const SolidPoints<Dim>& points, double dt) {
  using Rate = Eigen::Matrix<double, Dim, Dim>;
  shear_rate_.resize(points.size());
  for (int p = 0; p < points.size(); ++p) {
    const Rate& f = increments[points.element[p]];
    Rate rate = (f + f.transpose()) / (2.0 * dt) - Rate::Identity() / dt;
    rate -= rate.trace() / Dim * Rate::Identity();
    shear_rate_[p] = std::sqrt(2.0) * rate.norm();
  }
}

template <int Dim>
InertialStep InertialMotion<Dim>::step(SolidPoints<Dim>& points,
                                       const std::vector<PointSkeleton>& skeleton,
                                       const std::vector<double>& mass,
                                       const NodeVectors<Dim>& loads, double longest) {
  const PointsByElement sorted(grid_.mesh.element_count(), points.element);
  const ElementClasses classes(grid_, points, sorted);
  const NodalMotion<Dim> nodes = velocities_.to_nodes(grid_, points, mass);
  // Inertia supports a piece of soil that is connected by one node.
  Equilibrium<Dim> equilibrium({grid_, points, sorted, skeleton, classes, 0.0}, supports_,
                               threads_);
  InertialStep result{.duration = first_try(points, nodes, longest)};
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
    if (largest_travel(grid_, points, solution.displacement) > 1.5 * limits_.max_travel) continue;
    result.iterations = solution.iterations();
    result.inertia_share = equilibrium.inertia_norm() / norm<Dim>(loads);
    find_shear_rates(increments_of(grid_, solution.displacement), points, dt);
    velocities_.take(grid_, points, times<Dim>(1.0 / dt, solution.displacement), nodes.mass);
    move_points(grid_, skeleton, solution.displacement,
                equilibrium.law_increments(solution.displacement), points, threads_);
    space_points(grid_, supports_, solution.displacement, points);
    plan_next(result);
    return result;
  }
}

}  // namespace suffuse::model
