#include "motion/point_spacing.hpp"

#include <algorithm>
#include <cmath>

#include "grid/near_element.hpp"
#include "motion/solid_flux.hpp"

namespace suffuse {
namespace {

/// Points may overlap by this share of the room around a node: that much comes and goes as points
/// cross elements.
constexpr double allowed_excess = 0.25;
/// Passes end when no node has more than this above the allowed excess.
constexpr double small_excess = 0.05;
constexpr int max_spreadings = 10;
/// Motion along the gradient of the excess, over the squared height of the element. More than 0.8
/// makes points oscillate.
constexpr double pace = 0.4;

/// Volume of points above the allowed one, over the volume of each element.
template <int Dim>
std::vector<double> excess_of(const Grid<Dim>& grid, const Supports<Dim>& supports,
                              const SolidPoints<Dim>& points) {
  std::vector<double> excess =
      smooth_volumes(grid, points, points.volume, supports.rigid_elements());
  for (std::size_t e = 0; e < excess.size(); ++e) {
    excess[e] = std::max(0.0, excess[e] / grid.volume[e] - 1.0 - allowed_excess);
  }
  return excess;
}

/// Means of the elements around each node.
template <int Dim>
std::vector<double> at_nodes(const Grid<Dim>& grid, const std::vector<double>& of_elements) {
  std::vector<double> sum(grid.mesh.node_count(), 0.0);
  std::vector<double> volume(grid.mesh.node_count(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (const int i : grid.mesh.elements[e]) {
      sum[i] += grid.volume[e] * of_elements[e];
      volume[i] += grid.volume[e];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= volume[i];
  return sum;
}

/// Motion of the nodes from where points overlap, along their free directions, m.
template <int Dim>
NodeVectors<Dim> spreading(const Grid<Dim>& grid, const Supports<Dim>& supports,
                           const std::vector<double>& excess,
                           const NodeVectors<Dim>& displacement) {
  NodeVectors<Dim> motion(excess.size(), Vector<Dim>::Zero());
  std::vector<double> volume(excess.size(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    Vector<Dim> gradient = Vector<Dim>::Zero();
    for (int a = 0; a <= Dim; ++a) {
      gradient += excess[grid.mesh.elements[e][a]] * grid.shape_gradient[e][a];
    }
    double steepest = 0.0;  // one over the height, squared
    for (const Vector<Dim>& g : grid.shape_gradient[e]) {
      steepest = std::max(steepest, g.squaredNorm());
    }
    for (const int i : grid.mesh.elements[e]) {
      motion[i] -= pace / steepest * grid.volume[e] * gradient;
      volume[i] += grid.volume[e];
    }
  }
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const auto i = static_cast<int>(k);
    const auto free = supports.directions(i).leftCols(supports.free_count(i));
    motion[i] = free * (free.transpose() * motion[i]) / volume[i];
    const double length = motion[i].norm();
    const double most = displacement[i].norm();
    if (length > most) motion[i] *= most / length;
  }
  return motion;
}

}  // namespace

template <int Dim>
void space_points(const Grid<Dim>& grid, const Supports<Dim>& supports,
                  const NodeVectors<Dim>& displacement, SolidPoints<Dim>& points) {
  for (int pass = 0; pass < max_spreadings; ++pass) {
    const std::vector<double> excess = excess_of(grid, supports, points);
    if (std::ranges::max(excess) < small_excess) return;
    const NodeVectors<Dim> motion = spreading(grid, supports, at_nodes(grid, excess), displacement);
    for (int p = 0; p < points.size(); ++p) {
      const int e = points.element[p];
      const PointPlace<Dim> place{e, barycentric(grid.mesh, e, points.position[p])};
      const Vector<Dim> to = points.position[p] + interpolate(grid, place, motion);
      const int element = element_at(grid, e, to);
      if (element < 0) continue;
      points.position[p] = to;
      points.element[p] = element;
    }
  }
}

template void space_points(const Grid<2>&, const Supports<2>&, const NodeVectors<2>&,
                           SolidPoints<2>&);
template void space_points(const Grid<3>&, const Supports<3>&, const NodeVectors<3>&,
                           SolidPoints<3>&);

}  // namespace suffuse
