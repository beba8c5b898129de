#include "motion/soil_inertia.hpp"

#include <cmath>
#include <limits>

namespace suffuse {

template <int Dim>
void SoilInertia<Dim>::begin(int point_count) {
  *this = {};
  velocities_ = PointVelocities<Dim>(point_count);
}

template <int Dim>
double SoilInertia<Dim>::longest_step() const {
  return rate_ > 0.0 ? max_travel / rate_ : std::numeric_limits<double>::infinity();
}

template <int Dim>
double SoilInertia<Dim>::take(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                              const NodalMotion<Dim>& nodes, const NodeVectors<Dim>& displacement,
                              const std::vector<double>& mass, double duration, double travel,
                              double share) {
  NodeVectors<Dim> velocity = displacement;
  for (Vector<Dim>& v : velocity) v /= duration;
  velocities_.take(grid, points, std::move(velocity), nodes.mass);
  rate_ = travel / duration;
  share_ = share;
  return velocities_.kinetic_energy(mass);
}

double SoilExtent::time_of_fall() const {
  return std::sqrt(2.0 * height * mass / load);
}

bool SoilKinetics::is_rest() const {
  constexpr double small_share = 1e-2;
  constexpr double small_energy = 1e-6;
  return inertia_share < small_share && energy < small_energy * soil.load * soil.height;
}

bool SoilKinetics::is_slide() const {
  constexpr double large_energy = 1e-4;
  return energy > large_energy * soil.load * soil.height;
}

template class SoilInertia<2>;
template class SoilInertia<3>;

}  // namespace suffuse
