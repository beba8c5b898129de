#pragma once

/// Motion of dry soil whose inertia counts: soil that falls, swings or runs out. Each step is an
/// equilibrium with the forces of inertia (backward Euler), as long as Newton's method and the mesh
/// allow.

#include "deformation/newton.hpp"
#include "deformation/point_velocities.hpp"

namespace suffuse {

struct InertialLimits {
  double max_travel = 0.25;  ///< of a point in a step, over the height of its element
  double growth = 1.5;       ///< of a step over the one before
  /// A step that takes more iterations of Newton's method makes the next one shorter; one that
  /// takes at most half as many lets it grow.
  int many_iterations = 8;
  double shortest = 1e-7;  ///< s; no step is tried below this
  NewtonLimits newton = {.max_iterations = 12, .tolerance = 1e-5};
};

/// What a step did.
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
  /// Points at rest. Keeps references to grid and supports.
  InertialMotion(const Grid<Dim>& grid, const Supports<Dim>& supports, int point_count, int threads,
                 const InertialLimits& limits = {})
      : grid_(grid),
        supports_(supports),
        threads_(threads),
        limits_(limits),
        velocities_(point_count) {}

  [[nodiscard]] PointVelocities<Dim>& velocities() { return velocities_; }
  [[nodiscard]] const PointVelocities<Dim>& velocities() const { return velocities_; }

  /// Moves the points by one step of at most `longest` seconds. Throws NumericalError where no step
  /// is short enough, or a point leaves the mesh.
  /// \param skeleton  per point
  /// \param mass      per point, kg
  /// \param loads     per node, N: the weight of the points among them
  InertialStep step(SolidPoints<Dim>& points, const std::vector<PointSkeleton>& skeleton,
                    const std::vector<double>& mass, const NodeVectors<Dim>& loads, double longest);

  void archive(auto& archive) { archive(velocities_, next_); }

 private:
  [[nodiscard]] double first_try(const PointsByElement& sorted, const NodalMotion<Dim>& nodes,
                                 double longest) const;
  void plan_next(const InertialStep& step);

  const Grid<Dim>& grid_;
  const Supports<Dim>& supports_;
  int threads_;
  InertialLimits limits_;
  PointVelocities<Dim> velocities_;
  double next_ = 0.0;  ///< length of the next step, s; 0: not known
};

/// Whether soil has come to rest: inertia carries less than 1 % of the loads, and the kinetic
/// energy, J, is less than 1e-6 of the soil's weight, N, times its height, m.
[[nodiscard]] bool is_at_rest(const InertialStep& step, double kinetic_energy, double weight,
                              double height);

}  // namespace suffuse
