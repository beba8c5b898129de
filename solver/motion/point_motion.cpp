#include "motion/point_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <sstream>

#include "grid/parallel.hpp"
#include "grid/section_line.hpp"

namespace suffuse {
namespace {

/// A place so little outside an element, in barycentric coordinates, belongs to it: a point on a
/// face does not leave the mesh by round-off.
constexpr double on_face = 1e-12;
/// Soil may rise over the border of the mesh by this share of the height of the element there,
/// which its points then still belong to.
constexpr double over_border = 0.5;

template <int Dim>
double least_barycentric(const Grid<Dim>& grid, int element, const Vector<Dim>& x) {
  return std::ranges::min(barycentric(grid.mesh, element, x));
}

/// The element with a node of this one that holds a place; -1 where there is none.
template <int Dim>
int neighbour_at(const Grid<Dim>& grid, int element, const Vector<Dim>& x) {
  for (const int i : grid.mesh.elements[element]) {
    for (int k = grid.node_element_begin[i]; k < grid.node_element_begin[i + 1]; ++k) {
      if (least_barycentric(grid, grid.node_element[k], x) >= -on_face) return grid.node_element[k];
    }
  }
  return -1;
}

template <int Dim>
Vector<Dim> displacement_at(const Grid<Dim>& grid, const PointPlace<Dim>& place,
                            const NodeVectors<Dim>& displacement) {
  return interpolate(grid, place, displacement);
}

template <int Dim>
[[noreturn]] void refuse_outside(const Vector<Dim>& from, const Vector<Dim>& to, int point) {
  std::ostringstream message;
  message << "solid point " << point << " moves from (" << from.transpose() << ") to ("
          << to.transpose()
          << "), which is far outside the mesh; make the mesh larger, fix the boundary that it "
             "passes, or take shorter steps";
  throw NumericalError(message.str());
}

}  // namespace

template <int Dim>
int element_at(const Grid<Dim>& grid, int start, const Vector<Dim>& x) {
  int e = start;
  for (int crossings = 0; crossings < max_crossings; ++crossings) {
    const std::array<double, Dim + 1> at = barycentric(grid.mesh, e, x);
    const auto lowest = std::ranges::min_element(at);
    if (*lowest >= -on_face) return e;
    const int next = grid.across(e, static_cast<int>(lowest - at.begin()));
    if (next < 0) break;  // outside, or beyond a corner of the border that points inwards
    e = next;
  }
  const int neighbour = neighbour_at(grid, e, x);
  if (neighbour >= 0) return neighbour;
  const bool is_near = least_barycentric(grid, e, x) >= -over_border;
  if (is_near && e == start) return e;
  const auto place = find_place(grid, x);
  if (place) return place->element;
  return is_near ? e : -1;
}

template <int Dim>
void move_points(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                 const NodeVectors<Dim>& displacement, SolidPoints<Dim>& points, int threads) {
  using Gradient = Eigen::Matrix<double, Dim, Dim>;
  const int count = points.size();
  std::vector<Vector<Dim>> position(count);
  std::vector<int> element(count);
  for_each_index(count, threads, [&](int p) {
    const int e = points.element[p];
    const PointPlace<Dim> place{e, barycentric(grid.mesh, e, points.position[p])};
    position[p] = points.position[p] + displacement_at(grid, place, displacement);
    element[p] = element_at(grid, e, position[p]);
  });
  const auto outside = std::ranges::find(element, -1);
  if (outside != element.end()) {
    const auto p = static_cast<int>(outside - element.begin());
    refuse_outside<Dim>(points.position[p], position[p], p);
  }
  for_each_index(count, threads, [&](int p) {
    const int e = points.element[p];
    Gradient f = Gradient::Identity();
    for (int a = 0; a <= Dim; ++a) {
      f += displacement[grid.mesh.elements[e][a]] * grid.shape_gradient[e][a].transpose();
    }
    const SkeletonResponse response =
        skeleton_response<Dim>(*skeleton[p].law, skeleton[p].parameters, points.elastic_b[p], f);
    points.elastic_b[p] = response.elastic_b;
    points.plastic_strain[p] += response.plastic_strain;
    points.volume[p] *= f.determinant();
  });
  points.position = std::move(position);
  points.element = std::move(element);
}

template <int Dim>
double largest_travel(const Grid<Dim>& grid, const PointsByElement& sorted,
                      const NodeVectors<Dim>& displacement) {
  double largest = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (sorted.is_empty(e)) continue;
    double steepest = 0.0;  // one over the height
    double moved = 0.0;
    for (int a = 0; a <= Dim; ++a) {
      steepest = std::max(steepest, grid.shape_gradient[e][a].norm());
      moved = std::max(moved, displacement[grid.mesh.elements[e][a]].norm());
    }
    largest = std::max(largest, steepest * moved);
  }
  return largest;
}

template int element_at(const Grid<2>&, int, const Vector<2>&);
template int element_at(const Grid<3>&, int, const Vector<3>&);
template void move_points(const Grid<2>&, const std::vector<PointSkeleton>&, const NodeVectors<2>&,
                          SolidPoints<2>&, int);
template void move_points(const Grid<3>&, const std::vector<PointSkeleton>&, const NodeVectors<3>&,
                          SolidPoints<3>&, int);
template double largest_travel(const Grid<2>&, const PointsByElement&, const NodeVectors<2>&);
template double largest_travel(const Grid<3>&, const PointsByElement&, const NodeVectors<3>&);

}  // namespace suffuse
