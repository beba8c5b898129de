#include "motion/soil_inertia.hpp"

#include <limits>

namespace suffuse {

template <int Dim>
void SoilInertia<Dim>::begin(int point_count) {
  *this = {};
  velocities_ = PointVelocities<Dim>(point_count);
  way_.assign(point_count, 0.0);
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
  for (int p = 0; p < points.size(); ++p) way_[p] += velocities_.velocity(p).norm() * duration;
  rate_ = travel / duration;
  share_ = share;
  return velocities_.kinetic_energy(mass);
}

template class SoilInertia<2>;
template class SoilInertia<3>;

}  // namespace suffuse
