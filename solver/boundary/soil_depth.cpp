#include "boundary/soil_depth.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace suffuse {
namespace {

template <int Dim>
using Corners = std::array<Vector<Dim>, Dim>;

template <int Dim>
double distance_to_segment(const Vector<Dim>& x, const Vector<Dim>& a, const Vector<Dim>& b) {
  const Vector<Dim> along = b - a;
  const double share = std::clamp(along.dot(x - a) / along.squaredNorm(), 0.0, 1.0);
  return (x - a - share * along).norm();
}

double distance_to_face(const Vector<2>& x, const Corners<2>& face) {
  return distance_to_segment<2>(x, face[0], face[1]);
}

double distance_to_face(const Vector<3>& x, const Corners<3>& face) {
  const Vector<3> normal = (face[1] - face[0]).cross(face[2] - face[0]).normalized();
  const double height = normal.dot(x - face[0]);
  const Vector<3> foot = x - height * normal;
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const Vector<3>& a = face[k];
    const Vector<3>& b = face[(k + 1) % 3];
    inside = inside && normal.dot((b - a).cross(foot - a)) >= 0.0;
    nearest = std::min(nearest, distance_to_segment<3>(x, a, b));
  }
  return inside ? std::abs(height) : nearest;
}

template <int Dim>
std::vector<Corners<Dim>> surface(const Grid<Dim>& grid, const Supports<Dim>& supports,
                                  const PointsByElement& sorted) {
  std::vector<Corners<Dim>> result;
  for (int f = 0; f < grid.face_count(); ++f) {
    const int left = grid.face_left[f];
    const int right = grid.face_right[f];
    if (right >= 0
            ? sorted.is_empty(left) == sorted.is_empty(right)
            : sorted.is_empty(left) || !grid.is_border(f) || supports.holds_normal(grid, f)) {
      continue;
    }
    Corners<Dim> corners;
    for (int k = 0; k < Dim; ++k) corners[k] = grid.mesh.nodes[grid.face_nodes[f][k]];
    result.push_back(corners);
  }
  return result;
}

}  // namespace

template <int Dim>
std::vector<double> depths_below_surface(const Grid<Dim>& grid, const Supports<Dim>& supports,
                                         const SolidPoints<Dim>& points,
                                         const PointsByElement& sorted) {
  const std::vector<Corners<Dim>> faces = surface(grid, supports, sorted);
  std::vector<double> depths(points.position.size(), std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < depths.size(); ++p) {
    for (const Corners<Dim>& face : faces) {
      depths[p] = std::min(depths[p], distance_to_face(points.position[p], face));
    }
  }
  return depths;
}

template std::vector<double> depths_below_surface(const Grid<2>&, const Supports<2>&,
                                                  const SolidPoints<2>&, const PointsByElement&);
template std::vector<double> depths_below_surface(const Grid<3>&, const Supports<3>&,
                                                  const SolidPoints<3>&, const PointsByElement&);

}  // namespace suffuse
