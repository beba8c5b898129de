/// The inertia of a moving skeleton: masses and velocities.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "motion/held_by_inertia.hpp"
#include "motion/moving_skeleton.hpp"
#include "physics/head.hpp"
#include "solid/masses_in_motion.hpp"

namespace suffuse {
namespace {

/// The motion of soil is compared with the weight, the loads and the height of all ground, but with
/// at most this many times those of the soil that moves.
constexpr double ground_at_most = 10.0;

/// Mass, load and height that the motion of soil is compared with.
/// \param mass    that has inertia, kg per point
/// \param moving  the part of it in motion
template <int Dim>
SoilExtent extent_of(const SolidPoints<Dim>& points, const Scene& scene,
                     const std::vector<double>& mass, const std::vector<double>& moving,
                     const NodeVectors<Dim>& loads) {
  const double all = std::reduce(mass.begin(), mass.end());
  const double part = ground_at_most * std::reduce(moving.begin(), moving.end());
  SoilExtent extent{.mass = std::min(all, part)};
  extent.load = acceleration(scene.gravity) * extent.mass;
  if (!has_gravity(scene.gravity)) {
    for (const Vector<Dim>& force : loads) extent.load += force.norm();
    if (part < all) extent.load *= part / all;
  }
  const Vector<Dim> down = downwards<Dim>(scene.gravity);
  extent.height = std::min(height_of_block(points, down, mass),
                           ground_at_most * height_of_block(points, down, moving));
  return extent;
}

/// Kinetics of a step in equilibrium. `mass`: kg per point; `before`: places at its start, m.
template <int Dim>
SoilKinetics kinetics_of(const SolidPoints<Dim>& points, const Scene& scene,
                         const MotionStep<Dim>& step, const std::vector<double>& mass,
                         const std::vector<Vector<Dim>>& before) {
  SoilKinetics found;
  std::vector<double> way(mass.size());
  for (std::size_t p = 0; p < way.size(); ++p) {
    way[p] = (points.position[p] - before[p]).norm();
    found.energy += 0.5 * mass[p] * std::pow(way[p] / step.forcing.duration, 2);
  }
  found.soil = extent_of(points, scene, mass, masses_in_motion(mass, way), step.loads);
  return found;
}

/// Loads of the nodes in a step; with gravity the weight of the nodes, N.
template <int Dim>
std::vector<double> node_loads(const Scene& scene, const MotionStep<Dim>& step) {
  std::vector<double> load = step.nodes.mass;
  for (std::size_t i = 0; i < load.size(); ++i)
    load[i] =
        has_gravity(scene.gravity) ? acceleration(scene.gravity) * load[i] : step.loads[i].norm();
  return load;
}

/// Forces of inertia over the loads.
template <int Dim>
double inertia_share(const MotionStep<Dim>& step, const std::vector<double>& load) {
  const double squared = std::inner_product(load.begin(), load.end(), load.begin(), 0.0);
  return squared > 0.0 ? step.equilibrium->equilibrium().inertia_norm() / std::sqrt(squared) : 0.0;
}

/// Norm of the loads that the motion of soil is compared with, over that of `load`, of all nodes.
/// A node bears loads for the soil in motion by its share of the mass.
/// \param all, moving  mass of each node, and the part of it in motion, kg
double share_of_loads(const std::vector<double>& load, const std::vector<double>& all,
                      const std::vector<double>& moving) {
  double whole = 0.0;
  double part = 0.0;
  for (std::size_t i = 0; i < load.size(); ++i) {
    whole += load[i] * load[i];
    if (moving[i] > 0.0) part += std::pow(moving[i] / all[i] * load[i], 2);
  }
  return part < whole ? std::min(ground_at_most * std::sqrt(part / whole), 1.0) : 1.0;
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
  return kinetics_of(points_, this->soils().scene(), step, moved_masses(step), before);
}

template <int Dim>
SoilKinetics MovingSkeleton<Dim>::take_velocities(const MotionStep<Dim>& step) {
  const Scene& scene = this->soils().scene();
  const std::vector<double> load = node_loads(scene, step);
  SoilKinetics found{.inertia_share = inertia_share(step, load)};
  const NodeVectors<Dim>& displacement = step.equilibrium->displacement();
  found.energy = inertia_.take(this->grid_, points_, step.nodes, displacement, step.mass,
                               step.forcing.duration, step.motion.travel, found.inertia_share);
  const std::vector<double> moving = masses_in_motion(step.mass, inertia_.way());
  const NodalMotion<Dim> nodes = inertia_.nodes(this->grid_, points_, moving);
  found.soil = extent_of(points_, scene, step.mass, moving, step.loads);
  found.load_share = share_of_loads(load, step.nodes.mass, nodes.mass);
  return found;
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
