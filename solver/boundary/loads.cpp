#include "boundary/loads.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "grid/near_element.hpp"
#include "mesh/place_text.hpp"
#include "physics/head.hpp"

namespace suffuse {
namespace {

/// Lowest barycentric coordinate of a place above the mesh, times -1.
constexpr double allowed_above = 0.5;

/// Places on a face with equal shares of its area, in barycentric coordinates: the Gauss points of
/// degree 3 (two nodes) or 2 (three nodes).
template <int Dim>
std::array<std::array<double, Dim>, Dim> places_on_face() {
  const double near = Dim == 2 ? 0.5 + std::sqrt(1.0 / 12.0) : 2.0 / 3.0;
  std::array<std::array<double, Dim>, Dim> result;
  for (int j = 0; j < Dim; ++j) {
    result[j].fill((1.0 - near) / (Dim - 1));
    result[j][j] = near;
  }
  return result;
}

/// Area of a face with these corners, times its normal, m2.
template <int Dim>
Vector<Dim> vector_area(const std::vector<Vector<Dim>>& corner, const std::array<int, Dim>& face) {
  const Vector<Dim> along = corner[face[1]] - corner[face[0]];
  if constexpr (Dim == 2) {
    return {along[1], -along[0]};
  } else {
    return 0.5 * along.cross(corner[face[2]] - corner[face[0]]);
  }
}

/// The element that holds a place of a surface, or this one if the place is slightly above the
/// mesh.
template <int Dim>
int element_next_to(const Grid<Dim>& grid, int element, const Vector<Dim>& x) {
  const int e = element_at(grid, element, x);
  if (e >= 0) return e;
  if (std::ranges::min(barycentric(grid.mesh, element, x)) > -allowed_above) return element;
  throw NumericalError("the loaded surface moves to " + place_text<Dim>(x) +
                       ", which is far outside the mesh; make the mesh larger");
}

/// The soil that carries a load at a place: from an element without soil through the faces most
/// opposite to the surface's normal.
template <int Dim>
PointPlace<Dim> carrier(const Grid<Dim>& grid, const PointsByElement& sorted, int element,
                        const Vector<Dim>& normal, const Vector<Dim>& x) {
  constexpr int farthest = 4;  // most elements between a surface and its soil
  int e = element;
  for (int step = 0; step < farthest && sorted.is_empty(e); ++step) {
    int next = -1;
    double lowest = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      const Vector<Dim> out = grid.outward_normal(e, k);
      const double along = out.dot(normal) / (out.norm() * normal.norm());
      if (grid.across(e, k) < 0 || along >= lowest) continue;
      lowest = along;
      next = grid.across(e, k);
    }
    if (next < 0) break;
    e = next;
  }
  if (sorted.is_empty(e)) {
    throw NumericalError("the loaded surface at " + place_text<Dim>(x) +
                         " has lost its soil: there is none within " + std::to_string(farthest) +
                         " elements below");
  }
  return {e, barycentric(grid.mesh, e, x)};
}

}  // namespace

template <int Dim>
void add_point_forces(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                      const std::vector<Vector<Dim>>& force, NodalLoads<Dim>& loads) {
  const std::vector<char> all(grid.mesh.node_count(), 1);
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    const auto share = barycentric(grid.mesh, e, points.position[p]);
    loads.add(
        grid.mesh.elements[e], [&](std::size_t a) { return Vector<Dim>(share[a] * force[p]); },
        EdgeShare<Dim>::volume, all);
  }
}

template <int Dim>
void add_weight(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                const std::vector<double>& soil_volume, const SoilMass& mass,
                const std::array<double, 3>& gravity, NodalLoads<Dim>& loads) {
  const Vector<Dim> g = Eigen::Map<const Vector<Dim>>(gravity.data());
  std::vector<Vector<Dim>> weight(points.size());
  for (int p = 0; p < points.size(); ++p) weight[p] = mass.solid[p] * g;
  add_point_forces(grid, points, weight, loads);
  if (mass.liquid.empty()) return;
  const std::vector<char> all(grid.mesh.node_count(), 1);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const Vector<Dim> of_node = mass.liquid[e] * soil_volume[e] / (Dim + 1) * g;
    loads.add(
        grid.mesh.elements[e], [&](std::size_t) { return Vector<Dim>(of_node); },
        EdgeShare<Dim>::volume, all);
  }
}

template <int Dim>
std::vector<Vector<Dim>> unit_weights(const SolidPoints<Dim>& points,
                                      const std::vector<double>& soil_volume, const SoilMass& mass,
                                      const std::array<double, 3>& gravity) {
  const Vector<Dim> g = Eigen::Map<const Vector<Dim>>(gravity.data());
  std::vector<double> solid(soil_volume.size(), 0.0);
  for (int p = 0; p < points.size(); ++p) solid[points.element[p]] += mass.solid[p];
  std::vector<Vector<Dim>> result(solid.size(), Vector<Dim>::Zero());
  for (std::size_t e = 0; e < solid.size(); ++e) {
    if (soil_volume[e] == 0.0) continue;
    const double liquid = mass.liquid.empty() ? 0.0 : mass.liquid[e];
    result[e] = (solid[e] / soil_volume[e] + liquid) * g;
  }
  return result;
}

template <int Dim>
int soil_at(const Grid<Dim>& grid, const PointsByElement& sorted, int face) {
  const bool left = grid.is_outer(face) || !sorted.is_empty(grid.face_left[face]);
  return left ? grid.face_left[face] : grid.face_right[face];
}

template <int Dim>
std::vector<char> nodes_of_soil(const Grid<Dim>& grid, const PointsByElement& sorted) {
  std::vector<char> result(grid.mesh.node_count(), 0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (sorted.is_empty(e)) continue;
    for (const int i : grid.mesh.elements[e]) result[i] = 1;
  }
  return result;
}

template <int Dim>
Vector<Dim> downwards(const std::array<double, 3>& gravity) {
  if (!has_gravity(gravity)) return -Vector<Dim>::UnitY();
  return Eigen::Map<const Vector<Dim>>(gravity.data()).normalized();
}

template <int Dim>
LoadedSurface<Dim>::LoadedSurface(const Grid<Dim>& grid, const PointsByElement& sorted,
                                  const std::vector<int>& faces)
    : start_(faces) {
  std::map<int, int> corner_of_node;
  for (const int f : faces) {
    const int e = soil_at(grid, sorted, f);
    std::array<int, Dim> corners;
    for (int k = 0; k < Dim; ++k) {
      const int node = grid.face_nodes[f][k];
      const auto [known, is_new] = corner_of_node.emplace(node, static_cast<int>(corner_.size()));
      corners[k] = known->second;
      if (is_new) corner_.push_back(grid.mesh.nodes[node]);
    }
    const Vector<Dim> normal = e == grid.face_left[f] ? grid.face_normal[f] : -grid.face_normal[f];
    if (vector_area<Dim>(corner_, corners).dot(normal) < 0.0) std::swap(corners[0], corners[1]);
    face_.push_back(corners);
    for (int j = 0; j < Dim; ++j) {
      element_.push_back(e);
      area_.push_back(normal.norm() / Dim);
    }
  }
  follow_corners(grid);
}

template <int Dim>
void LoadedSurface<Dim>::follow_corners(const Grid<Dim>& grid) {
  position_.clear();
  normal_.clear();
  for (const std::array<int, Dim>& corners : face_) {
    for (const std::array<double, Dim>& share : places_on_face<Dim>()) {
      Vector<Dim> x = Vector<Dim>::Zero();
      for (int k = 0; k < Dim; ++k) x += share[k] * corner_[corners[k]];
      int& e = element_[position_.size()];
      e = element_next_to(grid, e, x);
      position_.push_back(x);
      normal_.push_back(vector_area<Dim>(corner_, corners) / Dim);
    }
  }
}

template <int Dim>
void LoadedSurface<Dim>::add_force(const Grid<Dim>& grid, const PointsByElement& sorted, int place,
                                   const Vector<Dim>& force, NodalLoads<Dim>& loads) const {
  loads.add_at(carrier(grid, sorted, element_[place], normal_[place], position_[place]), force);
}

template <int Dim>
void LoadedSurface<Dim>::add_traction(const Grid<Dim>& grid, const PointsByElement& sorted,
                                      const Vector<Dim>& traction, NodalLoads<Dim>& loads) const {
  for (int i = 0; i < static_cast<int>(area_.size()); ++i) {
    add_force(grid, sorted, i, area_[i] * traction, loads);
  }
}

template <int Dim>
void LoadedSurface<Dim>::move(const Grid<Dim>& grid, const PointsByElement& sorted,
                              const NodeVectors<Dim>& displacement) {
  // A corner at the edge of the soil may lie outside: it moves with the soil of the next place of
  // each of its faces.
  std::vector<Vector<Dim>> sum(corner_.size(), Vector<Dim>::Zero());
  std::vector<int> faces(corner_.size(), 0);
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const int c = face_[i / Dim][i % Dim];
    const int e = carrier(grid, sorted, element_[i], normal_[i], position_[i]).element;
    const PointPlace<Dim> place{e, barycentric(grid.mesh, e, corner_[c])};
    sum[c] += interpolate(grid, place, displacement);
    ++faces[c];
  }
  for (std::size_t c = 0; c < corner_.size(); ++c) corner_[c] += sum[c] / faces[c];
  follow_corners(grid);
}

template void add_point_forces(const Grid<2>&, const SolidPoints<2>&, const std::vector<Vector<2>>&,
                               NodalLoads<2>&);
template void add_point_forces(const Grid<3>&, const SolidPoints<3>&, const std::vector<Vector<3>>&,
                               NodalLoads<3>&);
template Vector<2> downwards<2>(const std::array<double, 3>&);
template Vector<3> downwards<3>(const std::array<double, 3>&);
template void add_weight(const Grid<2>&, const SolidPoints<2>&, const std::vector<double>&,
                         const SoilMass&, const std::array<double, 3>&, NodalLoads<2>&);
template std::vector<Vector<2>> unit_weights(const SolidPoints<2>&, const std::vector<double>&,
                                             const SoilMass&, const std::array<double, 3>&);
template std::vector<Vector<3>> unit_weights(const SolidPoints<3>&, const std::vector<double>&,
                                             const SoilMass&, const std::array<double, 3>&);
template int soil_at(const Grid<2>&, const PointsByElement&, int);
template std::vector<char> nodes_of_soil(const Grid<2>&, const PointsByElement&);
template void add_weight(const Grid<3>&, const SolidPoints<3>&, const std::vector<double>&,
                         const SoilMass&, const std::array<double, 3>&, NodalLoads<3>&);
template int soil_at(const Grid<3>&, const PointsByElement&, int);
template std::vector<char> nodes_of_soil(const Grid<3>&, const PointsByElement&);
template class LoadedSurface<2>;
template class LoadedSurface<3>;

}  // namespace suffuse
