#include "motion/crossing_forces.hpp"

#include <cmath>
#include <limits>

namespace suffuse {

template <int Dim>
void CrossingForces<Dim>::find(const Grid<Dim>& grid, const PointsByElement& sorted,
                               const Equilibrium<Dim>& moved, const NodeVectors<Dim>& loads,
                               const std::vector<double>& diffusivity) {
  force_ = moved.forces();
  for (std::size_t i = 0; i < force_.size(); ++i) force_[i] -= loads[i];
  // The slowest element around a node governs.
  fading_.assign(force_.size(), std::numeric_limits<double>::infinity());
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (sorted.is_empty(e)) continue;
    const double steepest = steepest_shape(grid, e);
    const double rate = diffusivity[e] * steepest * steepest / drainage_times;
    for (const int i : grid.mesh.elements[e]) fading_[i] = std::min(fading_[i], rate);
  }
}

template <int Dim>
void CrossingForces<Dim>::add(double duration, NodeVectors<Dim>& loads) const {
  for (std::size_t i = 0; i < force_.size(); ++i) {
    loads[i] += std::exp(-duration * fading_[i]) * force_[i];
  }
}

template <int Dim>
SoftStiffness CrossingForces<Dim>::soft_stiffness(double duration) const {
  constexpr double stiffness = 2.0;
  constexpr double times = 20.0;  // those of the forces
  SoftStiffness result{.strain = fading_};
  for (double& value : result.strain) value = stiffness * std::exp(-duration * value / times);
  return result;
}

template class CrossingForces<2>;
template class CrossingForces<3>;

}  // namespace suffuse
