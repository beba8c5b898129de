#include "boundary/virtual_stress.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "boundary/loads.hpp"

namespace suffuse {
namespace {

/// Lowest barycentric coordinate, on a face, of a place projected along the face's normal.
template <int Dim>
double lowest_on_face(const Grid<Dim>& grid, int face, const Vector<Dim>& x) {
  Eigen::Matrix<double, Dim + 1, Dim + 1> corners = Eigen::Matrix<double, Dim + 1, Dim + 1>::Zero();
  for (int k = 0; k < Dim; ++k) {
    corners.col(k) << grid.mesh.nodes[grid.face_nodes[face][k]], 1.0;
  }
  corners.col(Dim).template head<Dim>() = grid.face_normal[face].normalized();
  Eigen::Matrix<double, Dim + 1, 1> place;
  place << x, 1.0;
  const Eigen::Matrix<double, Dim + 1, 1> shares = corners.inverse() * place;
  return shares.template head<Dim>().minCoeff();
}

}  // namespace

template <int Dim>
VirtualStress<Dim>::VirtualStress(const Grid<Dim>& grid, const PointsByElement& sorted,
                                  std::vector<int> faces, std::vector<Vector<Dim>> places)
    : faces_(std::move(faces)), start_(std::move(places)) {
  std::vector<char> is_covered(grid.mesh.element_count(), 0);
  std::vector<int> visited(grid.mesh.element_count(), -1);
  for (int k = 0; k < static_cast<int>(faces_.size()); ++k) {
    const int f = faces_[k];
    const bool is_left = soil_at(grid, sorted, f) == grid.face_left[f];
    normal_.push_back(is_left ? grid.face_normal[f] : -grid.face_normal[f]);
    cover(grid, sorted, k, is_covered, visited);
  }
}

template <int Dim>
void VirtualStress<Dim>::cover(const Grid<Dim>& grid, const PointsByElement& sorted, int face,
                               std::vector<char>& is_covered, std::vector<int>& visited) {
  // Elements around the prism behind the face are passed through, as the centroid of an element
  // may lie beside the prism and that of the next one in it.
  constexpr double around = -1.0;
  std::vector<int> found{soil_at(grid, sorted, faces_[face])};
  visited[found.front()] = face;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const int e = found[i];
    const double lowest = lowest_on_face(grid, faces_[face], element_centroid(grid.mesh, e));
    if (lowest < around) continue;
    if (lowest >= 0.0 && is_covered[e] == 0) {
      is_covered[e] = 1;
      covered_.push_back({e, face});
    }
    for (int k = 0; k <= Dim; ++k) {
      const int next = grid.across(e, k);
      if (next < 0 || visited[next] == face || sorted.is_empty(next)) continue;
      visited[next] = face;
      found.push_back(next);
    }
  }
}

template <int Dim>
bool VirtualStress<Dim>::add(const Grid<Dim>& grid, const PointsByElement& sorted,
                             const std::vector<double>& soil_volume, const Vector<Dim>& traction,
                             NodalLoads<Dim>& loads) const {
  const std::vector<char> of_soil = nodes_of_soil(grid, sorted);
  NodalLoads<Dim> share = loads.none();  // of the area, as first component, m2
  double sum = 0.0;
  double whole = 0.0;
  const auto part = [&](double area) {
    sum += area;
    return Vector<Dim>(area * Vector<Dim>::UnitX());
  };
  for (std::size_t k = 0; k < faces_.size(); ++k) {
    whole += normal_[k].norm();
    share.add(
        grid.face_nodes[faces_[k]], [&](std::size_t) { return part(normal_[k].norm() / Dim); },
        EdgeShare<Dim>::face, of_soil);
  }
  for (const Covered& c : covered_) {
    const double left = grid.volume[c.element] - soil_volume[c.element];
    const Vector<Dim> normal = normal_[c.face].normalized();
    const auto& gradient = grid.shape_gradient[c.element];
    share.add(
        grid.mesh.elements[c.element],
        [&](std::size_t a) { return part(-left * normal.dot(gradient[a])); },
        EdgeShare<Dim>::stress, of_soil);
  }
  if (sum < 0.5 * whole) return false;
  // Elements across the border of the surface are covered whole or not at all: keep the force.
  const Vector<Dim> per_area = whole / sum * traction;
  for (std::size_t i = 0; i < loads.forces().size(); ++i) {
    loads.forces()[i] += share.forces()[i][0] * per_area;
  }
  return true;
}

template <int Dim>
double VirtualStress<Dim>::share(const Grid<Dim>& grid,
                                 const std::vector<Vector<Dim>>& places) const {
  double farthest = 0.0;  // over the height of an element
  const std::size_t on_face = places.size() / faces_.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t k = i / on_face;
    const Vector<Dim> normal = normal_[k].normalized();
    const Vector<Dim> moved = places[i] - start_[i];
    const double sideways = (moved - moved.dot(normal) * normal).norm();
    farthest = std::max(farthest, sideways * steepest_shape(grid, grid.face_left[faces_[k]]));
  }
  return std::clamp(2.0 - 2.0 * farthest, 0.0, 1.0);
}

template class VirtualStress<2>;
template class VirtualStress<3>;

}  // namespace suffuse
