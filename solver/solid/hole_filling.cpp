#include "solid/hole_filling.hpp"

#include <algorithm>
#include <numeric>

namespace suffuse {
namespace {

/// Least barycentric coordinate of a point that was moved into an element.
constexpr double depth = 0.05;

/// Elements without points that are no holes: they have a free outer face or a node without soil
/// around it, or others without points connect them with such an element.
template <int Dim>
std::vector<char> outside_of_soil(const Grid<Dim>& grid, const Supports<Dim>& supports,
                                  const std::vector<int>& count) {
  std::vector<char> outside(count.size(), 0);
  std::vector<int> found;
  const auto add = [&](int e) {
    if (count[e] > 0 || outside[e] != 0) return;
    outside[e] = 1;
    found.push_back(e);
  };
  for (int f = 0; f < grid.face_count(); ++f) {
    if (grid.is_outer(f) && !supports.holds_normal(grid, f)) add(grid.face_left[f]);
  }
  std::vector<char> at_soil(grid.mesh.node_count(), 0);
  for (std::size_t e = 0; e < count.size(); ++e) {
    if (count[e] == 0) continue;
    for (const int node : grid.mesh.elements[e]) at_soil[node] = 1;
  }
  const auto is_bare = [&](int node) { return at_soil[node] == 0; };
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (std::ranges::any_of(grid.mesh.elements[e], is_bare)) add(e);
  }
  while (!found.empty()) {
    const int e = found.back();
    found.pop_back();
    for (int k = 0; k <= Dim; ++k)
      if (const int other = grid.across(e, k); other >= 0) add(other);
  }
  return outside;
}

}  // namespace

template <int Dim>
void fill_holes(const Grid<Dim>& grid, const Supports<Dim>& supports, SolidPoints<Dim>& points,
                std::vector<Vector<Dim>>& start) {
  const int elements = grid.mesh.element_count();
  const PointsByElement sorted(elements, points.element);
  std::vector<int> count(elements);
  for (int e = 0; e < elements; ++e) count[e] = static_cast<int>(sorted.of(e).size());
  const std::vector<char> outside = outside_of_soil(grid, supports, count);
  for (int e = 0; e < elements; ++e) {
    if (count[e] > 0 || outside[e] != 0 || supports.is_rigid(e)) continue;
    int nearest = -1;
    std::array<double, Dim + 1> place{};
    double least = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      const int other = grid.across(e, k);
      if (other < 0 || count[other] < 2 || supports.is_rigid(other)) continue;
      for (const int p : sorted.of(other)) {
        if (points.element[p] != other) continue;
        const auto from_e = barycentric(grid.mesh, e, points.position[p]);
        if (nearest >= 0 && std::ranges::min(from_e) <= least) continue;
        nearest = p;
        place = from_e;
        least = std::ranges::min(from_e);
      }
    }
    if (nearest < 0) continue;
    --count[points.element[nearest]];
    ++count[e];
    for (double& coordinate : place) coordinate = std::max(coordinate, depth);
    const double sum = std::accumulate(place.begin(), place.end(), 0.0);
    Vector<Dim> there = Vector<Dim>::Zero();
    for (int a = 0; a <= Dim; ++a)
      there += place[a] / sum * grid.mesh.nodes[grid.mesh.elements[e][a]];
    start[nearest] += there - points.position[nearest];
    points.position[nearest] = there;
    points.element[nearest] = e;
  }
}

template void fill_holes(const Grid<2>&, const Supports<2>&, SolidPoints<2>&,
                         std::vector<Vector<2>>&);
template void fill_holes(const Grid<3>&, const Supports<3>&, SolidPoints<3>&,
                         std::vector<Vector<3>>&);

}  // namespace suffuse
