#include "motion/soil_inertia.hpp"

#include <cmath>
#include <limits>

namespace suffuse {

template <int Dim>
void SoilInertia<Dim>::begin(int point_count) {
  end();
  velocities_ = PointVelocities<Dim>(point_count);
}

template <int Dim>
void SoilInertia<Dim>::end() {
  velocities_ = {};
  rate_ = 0.0;
  share_ = 0.0;
  rested_ = 0.0;
}

template <int Dim>
double SoilInertia<Dim>::longest_step() const {
  return rate_ > 0.0 ? max_travel / rate_ : std::numeric_limits<double>::infinity();
}

template <int Dim>
void SoilInertia<Dim>::start_step(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                  std::vector<double> mass) {
  mass_ = std::move(mass);
  nodes_ = velocities_.to_nodes(grid, points, mass_);
}

template <int Dim>
void SoilInertia<Dim>::finish_step(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                   const NodeVectors<Dim>& displacement, double duration,
                                   double travel, double share, const SoilExtent& extent) {
  NodeVectors<Dim> velocity = displacement;
  for (Vector<Dim>& v : velocity) v /= duration;
  velocities_.take(grid, points, std::move(velocity), nodes_.mass);
  rate_ = travel / duration;
  share_ = share;
  const bool rests = is_at_rest(share, velocities_.kinetic_energy(mass_), extent);
  rested_ = rests ? rested_ + duration : 0.0;
  if (rested_ > extent.time_of_fall()) end();
}

double SoilExtent::time_of_fall() const {
  return std::sqrt(2.0 * height * mass / load);
}

bool is_at_rest(double inertia_share, double kinetic_energy, const SoilExtent& extent) {
  constexpr double small_share = 1e-2;
  constexpr double small_energy = 1e-6;
  return inertia_share < small_share && kinetic_energy < small_energy * extent.load * extent.height;
}

bool is_sliding(double kinetic_energy, const SoilExtent& extent) {
  constexpr double large_energy = 1e-4;
  return kinetic_energy > large_energy * extent.load * extent.height;
}

template class SoilInertia<2>;
template class SoilInertia<3>;

}  // namespace suffuse
