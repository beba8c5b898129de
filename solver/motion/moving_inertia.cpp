/// The inertia of a moving skeleton: masses and velocities.

#include <cmath>

#include "motion/held_by_inertia.hpp"
#include "motion/moving_skeleton.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

/// Mass, load and height that the motion of soil is compared with.
/// \param mass  that has inertia, kg per point
template <int Dim>
SoilExtent extent_of(const SolidPoints<Dim>& points, const Supports<Dim>& supports,
                     const Scene& scene, const std::vector<double>& mass,
                     const NodeVectors<Dim>& loads) {
  SoilExtent extent;
  for (const double m : mass) extent.mass += m;
  extent.load = acceleration(scene.gravity) * extent.mass;
  if (!has_gravity(scene.gravity)) {
    for (const Vector<Dim>& force : loads) extent.load += force.norm();
  }
  const Vector<Dim> down = downwards<Dim>(scene.gravity);
  int top = -1;
  int bottom = -1;
  for (int p = 0; p < points.size(); ++p) {
    if (supports.is_rigid(points.element[p])) continue;
    const double depth = points.position[p].dot(down);
    if (top < 0 || depth < points.position[top].dot(down)) top = p;
    if (bottom < 0 || depth >= points.position[bottom].dot(down)) bottom = p;
  }
  if (top >= 0) extent.height = (points.position[bottom] - points.position[top]).dot(down);
  return extent;
}

/// Norm of the loads of a step; with gravity that of the weight of the nodes, N.
template <int Dim>
double load_norm(const Scene& scene, const MotionStep<Dim>& step) {
  if (!has_gravity(scene.gravity)) return norm<Dim>(step.loads);
  double squared = 0.0;
  for (const double mass : step.nodes.mass) squared += mass * mass;
  return acceleration(scene.gravity) * std::sqrt(squared);
}

/// Kinetic energy of points that have moved in a time, J; `mass` in kg, `before` and `after` in m.
template <int Dim>
double kinetic_energy(const std::vector<double>& mass, const std::vector<Vector<Dim>>& before,
                      const std::vector<Vector<Dim>>& after, double duration) {
  double sum = 0.0;
  for (std::size_t p = 0; p < mass.size(); ++p)
    sum += mass[p] * (after[p] - before[p]).squaredNorm();
  return 0.5 * sum / (duration * duration);
}

/// Mass of soil with the liquid in its pores, per node, kg.
/// \param mass  of the solid, kg per point
template <int Dim>
std::vector<double> node_masses(const Skeleton<Dim>& soil, const Grid<Dim>& grid,
                                const SolidPoints<Dim>& points, std::vector<double> mass) {
  for (int p = 0; p < points.size(); ++p) {
    const double liquid = points.volume[p] - soil.state().solid_volume(p);
    mass[p] += liquid * soil.soils().scene().liquid.density;
  }
  return PointVelocities<Dim>(points.size()).to_nodes(grid, points, mass).mass;
}

}  // namespace

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::compressibility(double duration) const {
  std::vector<double> result = drained_compressibility();
  if (!inertia_.acts()) return result;
  return held_compressibility(this->grid_, std::move(result),
                              node_masses(*this, this->grid_, points_, solid_masses({})), duration);
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::inertial_mobility(double duration) const {
  if (!inertia_.acts()) return {};
  return held_mobility(this->grid_, drained_compressibility(),
                       node_masses(*this, this->grid_, points_, solid_masses({})), duration);
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::moved_masses(const MotionStep<Dim>& step) const {
  std::vector<double> mass = solid_masses(step.loss);
  for (int p = 0; p < points_.size(); ++p) {
    mass[p] += step.forcing.liquid_mass[points_.element[p]] * points_.volume[p];
    if (supports_.is_rigid(points_.element[p])) mass[p] = 0.0;
  }
  return mass;
}

template <int Dim>
SoilKinetics MovingSkeleton<Dim>::kinetics(const MotionStep<Dim>& step,
                                           const std::vector<Vector<Dim>>& before) const {
  const std::vector<double> mass = moved_masses(step);
  return {.energy = kinetic_energy<Dim>(mass, before, points_.position, step.forcing.duration),
          .soil = extent_of(points_, supports_, this->soils().scene(), mass, step.loads)};
}

template <int Dim>
SoilKinetics MovingSkeleton<Dim>::take_velocities(const MotionStep<Dim>& step) {
  const Scene& scene = this->soils().scene();
  const double loads = load_norm(scene, step);
  const double share = loads > 0.0 ? step.equilibrium->equilibrium().inertia_norm() / loads : 0.0;
  const double energy =
      inertia_.take(this->grid_, points_, step.nodes, step.equilibrium->displacement(), step.mass,
                    step.forcing.duration, step.motion.travel, share);
  return {energy, share, extent_of(points_, supports_, scene, step.mass, step.loads)};
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
