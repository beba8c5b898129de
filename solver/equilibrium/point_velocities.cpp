#include "equilibrium/point_velocities.hpp"

#include <algorithm>

namespace suffuse {
namespace {

/// Place of a point in its element. A point on the border of the mesh, or slightly outside, is
/// moved to the nearest place inside, so that no node gets a negative mass.
template <int Dim>
PointPlace<Dim> place_inside(const Grid<Dim>& grid, const SolidPoints<Dim>& points, int p) {
  const int e = points.element[p];
  PointPlace<Dim> place{e, barycentric(grid.mesh, e, points.position[p])};
  double sum = 0.0;
  for (double& share : place.barycentric) sum += share = std::max(0.0, share);
  for (double& share : place.barycentric) share /= sum;
  return place;
}

/// The largest share in [0, 1] of `change` that keeps `value` plus this share within the bounds.
double share_within(double value, double change, double low, double high) {
  const double slack = 1e-12 * (high - low);  // values of an element's own nodes are within bounds
  if (change > high - value + slack) return (high - value) / change;
  if (change < low - value - slack) return (low - value) / change;
  return 1.0;
}

}  // namespace

template <int Dim>
double PointVelocities<Dim>::limit(const Grid<Dim>& grid, int e, int p,
                                   const Vector<Dim>& place) const {
  if (of_nodes_.empty()) return 1.0;
  Vector<Dim> low = velocity_[p];
  Vector<Dim> high = velocity_[p];
  for (const int i : grid.mesh.elements[e]) {
    if (in_use_[i] == 0) continue;
    low = low.cwiseMin(of_nodes_[i]);
    high = high.cwiseMax(of_nodes_[i]);
  }
  double share = 1.0;
  for (const int i : grid.mesh.elements[e]) {
    const Vector<Dim> change = gradient_[p] * (grid.mesh.nodes[i] - place);
    for (int d = 0; d < Dim; ++d) {
      share = std::min(share, share_within(velocity_[p][d], change[d], low[d], high[d]));
    }
  }
  return share;
}

template <int Dim>
NodalMotion<Dim> PointVelocities<Dim>::to_nodes(const Grid<Dim>& grid,
                                                const SolidPoints<Dim>& points,
                                                const std::vector<double>& mass) const {
  NodalMotion<Dim> nodes;
  nodes.mass.assign(grid.mesh.node_count(), 0.0);
  nodes.velocity.assign(grid.mesh.node_count(), Vector<Dim>::Zero());
  for (int p = 0; p < points.size(); ++p) {
    const PointPlace<Dim> at = place_inside(grid, points, p);
    const Vector<Dim> place = at.position(grid.mesh);
    const double share = limit(grid, at.element, p, place);
    for (int a = 0; a <= Dim; ++a) {
      const int i = grid.mesh.elements[at.element][a];
      const double part = at.barycentric[a] * mass[p];
      const Vector<Dim> change = share * (gradient_[p] * (grid.mesh.nodes[i] - place));
      nodes.mass[i] += part;
      nodes.velocity[i] += part * (velocity_[p] + change);
    }
  }
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    if (nodes.mass[i] > 0.0) nodes.velocity[i] /= nodes.mass[i];
  }
  return nodes;
}

template <int Dim>
void PointVelocities<Dim>::take(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                NodeVectors<Dim> velocity, const std::vector<double>& mass) {
  for (int p = 0; p < points.size(); ++p) {
    const PointPlace<Dim> at = place_inside(grid, points, p);
    velocity_[p].setZero();
    gradient_[p].setZero();
    for (int a = 0; a <= Dim; ++a) {
      const Vector<Dim>& of_node = velocity[grid.mesh.elements[at.element][a]];
      velocity_[p] += at.barycentric[a] * of_node;
      gradient_[p] += of_node * grid.shape_gradient[at.element][a].transpose();
    }
  }
  of_nodes_ = std::move(velocity);
  in_use_.resize(mass.size());
  std::ranges::transform(mass, in_use_.begin(), [](double m) { return m > 0.0 ? 1 : 0; });
}

template <int Dim>
void PointVelocities<Dim>::reorder(const std::vector<int>& order) {
  suffuse::reorder(order, velocity_);
  suffuse::reorder(order, gradient_);
}

template <int Dim>
double PointVelocities<Dim>::kinetic_energy(const std::vector<double>& mass) const {
  double sum = 0.0;
  for (std::size_t p = 0; p < mass.size(); ++p) sum += 0.5 * mass[p] * velocity_[p].squaredNorm();
  return sum;
}

template class PointVelocities<2>;
template class PointVelocities<3>;

}  // namespace suffuse
