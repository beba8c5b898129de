#include "motion/point_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <sstream>

#include "grid/near_element.hpp"
#include "grid/parallel.hpp"
#include "grid/section_line.hpp"
#include "mesh/place_text.hpp"

namespace suffuse {
namespace {

/// Largest volume of a point over that at the start. Looser soil has come apart: what opens are not
/// its pores. Without a limit a single point fills many elements, and has the mass of their water.
constexpr double loosest = 4.0;

template <int Dim>
[[noreturn]] void refuse_outside(const Vector<Dim>& from, const Vector<Dim>& to, int point) {
  std::ostringstream message;
  message << "solid point " << point << " moves from " << place_text<Dim>(from) << " to "
          << place_text<Dim>(to)
          << ", which is far outside the mesh; make the mesh larger, fix the boundary that it "
             "passes, or take shorter steps";
  throw NumericalError(message.str());
}

}  // namespace

template <int Dim>
void move_points(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                 const NodeVectors<Dim>& displacement, const Increments<Dim>& increments,
                 SolidPoints<Dim>& points, int threads) {
  const int count = points.size();
  std::vector<Vector<Dim>> position(count);
  std::vector<int> element(count);
  for_each_index(count, threads, [&](int p) {
    const int e = points.element[p];
    const PointPlace<Dim> place{e, barycentric(grid.mesh, e, points.position[p])};
    position[p] = points.position[p] + interpolate(grid, place, displacement);
    element[p] = element_at(grid, e, position[p]);
  });
  const auto outside = std::ranges::find(element, -1);
  if (outside != element.end()) {
    const auto p = static_cast<int>(outside - element.begin());
    refuse_outside<Dim>(points.position[p], position[p], p);
  }
  for_each_index(count, threads, [&](int p) {
    const int e = points.element[p];
    const Eigen::Matrix<double, Dim, Dim>& f = increments[e];
    const SkeletonResponse response =
        skeleton_response<Dim>(*skeleton[p].law, skeleton[p].parameters, points.skeleton[p], f);
    points.skeleton[p] = response.state;
    points.plastic_strain[p] += response.plastic_strain;
    points.volume[p] =
        std::min(f.determinant() * points.volume[p], loosest * points.reference_volume[p]);
  });
  points.position = std::move(position);
  points.element = std::move(element);
}

template <int Dim>
double largest_travel(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                      const NodeVectors<Dim>& displacement) {
  double largest = 0.0;
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const PointPlace<Dim> place{e, barycentric(grid.mesh, e, points.position[p])};
    const double moved = interpolate(grid, place, displacement).norm();
    largest = std::max(largest, steepest_shape(grid, e) * moved);
  }
  return largest;
}

template void move_points(const Grid<2>&, const std::vector<PointSkeleton>&, const NodeVectors<2>&,
                          const Increments<2>&, SolidPoints<2>&, int);
template void move_points(const Grid<3>&, const std::vector<PointSkeleton>&, const NodeVectors<3>&,
                          const Increments<3>&, SolidPoints<3>&, int);
template double largest_travel(const Grid<2>&, const SolidPoints<2>&, const NodeVectors<2>&);
template double largest_travel(const Grid<3>&, const SolidPoints<3>&, const NodeVectors<3>&);

}  // namespace suffuse
