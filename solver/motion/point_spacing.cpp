#include "motion/point_spacing.hpp"

#include <algorithm>

#include "grid/near_element.hpp"
#include "motion/solid_flux.hpp"

namespace suffuse {
namespace {

/// Points may overfill an element by this share: that much comes and goes as they cross elements.
constexpr double allowed_excess = 0.25;
/// Passes end when no element has more than this above the allowed excess.
constexpr double small_excess = 0.05;
constexpr int max_spreadings = 10;
/// Motion over the gradient of the excess and the squared height of the element. On crossed meshes
/// 0.05 to 0.8 gave the same run-out; small values need more passes.
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

/// Motion of the nodes from where points overlap, along their free directions, m.
/// \param excess  per element
template <int Dim>
NodeVectors<Dim> spreading(const Grid<Dim>& grid, const Supports<Dim>& supports,
                           const std::vector<double>& excess,
                           const NodeVectors<Dim>& displacement) {
  const std::vector<double> at_nodes = means_at_nodes(grid, excess, 0.0);
  std::vector<Vector<Dim>> of_elements(excess.size());
  for (std::size_t e = 0; e < excess.size(); ++e) {
    Vector<Dim> gradient = Vector<Dim>::Zero();
    for (int a = 0; a <= Dim; ++a) {
      gradient += at_nodes[grid.mesh.elements[e][a]] * grid.shape_gradient[e][a];
    }
    const double steepest = steepest_shape(grid, static_cast<int>(e));
    of_elements[e] = -pace / (steepest * steepest) * gradient;
  }
  NodeVectors<Dim> motion =
      means_at_nodes<Dim, Vector<Dim>>(grid, of_elements, Vector<Dim>::Zero());
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const auto i = static_cast<int>(k);
    const auto free = supports.directions(i).leftCols(supports.free_count(i));
    motion[i] = free * (free.transpose() * motion[i]);
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
    const NodeVectors<Dim> motion = spreading(grid, supports, excess, displacement);
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
