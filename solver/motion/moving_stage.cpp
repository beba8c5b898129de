/// A moving skeleton that starts as another run has left its soil.

#include <algorithm>
#include <numeric>

#include "motion/moving_skeleton.hpp"

namespace suffuse {

template <int Dim>
MovedSoil<Dim> MovingSkeleton<Dim>::moved() const {
  MovedSoil<Dim> soil;
  soil.lasting() = lasting(*this);
  soil.has_inertia = has_inertia();
  soil.skeleton = skeletons({});
  soil.surfaces = boundary_loads_.surfaces();
  soil.has_soil = this->soils().has_soil();
  return soil;
}

template <int Dim>
void MovingSkeleton<Dim>::start_from(MovedSoil<Dim> earlier) {
  lasting(*this) = earlier.lasting();
  std::ranges::fill(points_.plastic_strain, 0.0);
  start_ = points_.position;
  id_.resize(points_.size());
  std::iota(id_.begin(), id_.end(), 0);
  boundary_loads_.place(earlier.surfaces);
  if (this->soils().deposits()) this->state_.deposited_volume.resize(points_.size(), 0.0);
  sort_points(0.0);
}

template <int Dim>
void MovingSkeleton<Dim>::start_construction(const std::vector<double>& pressure,
                                             const std::vector<double>& liquid_mass) {
  if (!crossing_forces_.empty()) return;  // nothing is built, and these keep the balance
  MotionStep<Dim> step = start_step({.liquid_mass = liquid_mass});
  step.pressure = pressure_ = pressure;
  find_crossing_forces(step);
  construction_ = {crossing_forces_.take(), this->soils().scene().construction_time()};
}

template <int Dim>
std::vector<double> MovingSkeleton<Dim>::load_breakpoints() const {
  std::vector<double> times = boundary_loads_.breakpoints();
  const Scene& scene = this->soils().scene();
  if (!scene.initial_from.empty()) times.push_back(scene.construction_time());
  return times;
}

template class MovingSkeleton<2>;
template class MovingSkeleton<3>;

}  // namespace suffuse
