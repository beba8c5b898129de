#include "solid/solid_points.hpp"

#include <algorithm>
#include <numeric>

namespace suffuse {

template <int Dim>
SolidPoints<Dim>::SolidPoints(const Mesh<Dim>& mesh, const std::vector<PointPlace<Dim>>& places,
                              std::vector<double> volume_in)
    : reference_volume(volume_in),
      volume(std::move(volume_in)),
      skeleton(places.size()),
      plastic_strain(places.size(), 0.0) {
  for (const PointPlace<Dim>& place : places) {
    position.push_back(place.position(mesh));
    element.push_back(place.element);
  }
}

template <int Dim>
void SolidPoints<Dim>::reorder(const std::vector<int>& order) {
  const auto all = [&](auto&... values) { (suffuse::reorder(order, values), ...); };
  all(position, element, reference_volume, volume, skeleton, plastic_strain);
}

PointsByElement::PointsByElement(int element_count, const std::vector<int>& element_of_point)
    : begin_(element_count + 1, 0), point_(element_of_point.size()) {
  for (const int e : element_of_point) ++begin_[e + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (int i = 0; i < std::ssize(point_); ++i) point_[next[element_of_point[i]]++] = i;
}

template <int Dim>
std::vector<double> node_shares(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                const std::vector<double>& volume, const std::vector<char>& rigid) {
  const auto counts = [&](int e) { return rigid.empty() || rigid[e] == 0; };
  std::vector<double> share(grid.mesh.node_count(), 0.0);
  for (int p = 0; p < points.size(); ++p) {
    const int e = points.element[p];
    if (!counts(e)) continue;
    const auto shape = barycentric(grid.mesh, e, points.position[p]);
    // A point on a side of its element may lie beyond it by round-off.
    const auto& nodes = grid.mesh.elements[e];
    for (int a = 0; a <= Dim; ++a) share[nodes[a]] += std::max(0.0, shape[a]) * volume[p];
  }
  std::vector<double> around = grid.node_volume;
  if (!rigid.empty()) {
    std::ranges::fill(around, 0.0);
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      if (!counts(e)) continue;
      for (const int i : grid.mesh.elements[e]) around[i] += grid.volume[e] / (Dim + 1);
    }
  }
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    if (around[i] > 0.0) share[i] /= around[i];
  }
  return share;
}

template struct SolidPoints<2>;
template struct SolidPoints<3>;
template std::vector<double> node_shares(const Grid<2>&, const SolidPoints<2>&,
                                         const std::vector<double>&, const std::vector<char>&);
template std::vector<double> node_shares(const Grid<3>&, const SolidPoints<3>&,
                                         const std::vector<double>&, const std::vector<char>&);

}  // namespace suffuse
