#include "solid/element_classes.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {
namespace {

/// Soil surrounds a node if it fills at least this share of the volume around it ...
constexpr double surrounded = 0.75;
/// ... and fills at most this share at a flat surface.
constexpr double at_surface = 0.5;

/// Per node: whether it is at the border of the mesh, in an element without points, or next to such
/// a node. Farther inside all elements are full, wherever their points lie.
template <int Dim>
std::vector<char> near_surface(const Grid<Dim>& grid, const PointsByElement& sorted) {
  std::vector<char> at(grid.mesh.node_count(), 0);
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_border(f)) continue;
    for (const int i : grid.face_nodes[f]) at[i] = 1;
  }
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!sorted.is_empty(e)) continue;
    for (const int i : grid.mesh.elements[e]) at[i] = 1;
  }
  std::vector<char> near = at;
  for (const auto& nodes : grid.mesh.elements) {
    if (std::ranges::none_of(nodes, [&](int i) { return at[i] != 0; })) continue;
    for (const int i : nodes) near[i] = 1;
  }
  return near;
}

}  // namespace

template <int Dim>
ElementClasses::ElementClasses(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                               const PointsByElement& sorted) {
  const int elements = grid.mesh.element_count();
  const std::vector<char> near = near_surface(grid, sorted);
  const std::vector<double> filled = node_shares(grid, points, points.volume);
  full.assign(elements, 0.0);
  scale.assign(elements, 0.0);
  for (int e = 0; e < elements; ++e) {
    if (sorted.is_empty(e)) continue;
    double least = surrounded;
    for (const int i : grid.mesh.elements[e]) {
      if (near[i] != 0) least = std::min(least, filled[i]);
    }
    full[e] = std::max(0.0, (least - at_surface) / (surrounded - at_surface));
    double volume = 0.0;
    for (const int p : sorted.of(e)) volume += points.volume[p];
    scale[e] = std::lerp(1.0, grid.volume[e] / volume, full[e]);
  }
}

template <int Dim>
std::vector<double> soil_volumes(const SolidPoints<Dim>& points, const PointsByElement& sorted,
                                 const ElementClasses& classes) {
  std::vector<double> result(classes.scale.size(), 0.0);
  for (std::size_t e = 0; e < result.size(); ++e) {
    for (const int p : sorted.of(static_cast<int>(e))) {
      result[e] += classes.scale[e] * points.volume[p];
    }
  }
  return result;
}

template <int Dim>
std::vector<double> sums_in_elements(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                     const std::vector<double>& values, double factor) {
  std::vector<double> result(grid.mesh.element_count(), 0.0);
  for (int p = 0; p < points.size(); ++p) result[points.element[p]] += factor * values[p];
  return result;
}

template std::vector<double> soil_volumes(const SolidPoints<2>&, const PointsByElement&,
                                          const ElementClasses&);
template std::vector<double> soil_volumes(const SolidPoints<3>&, const PointsByElement&,
                                          const ElementClasses&);
template ElementClasses::ElementClasses(const Grid<2>&, const SolidPoints<2>&,
                                        const PointsByElement&);
template ElementClasses::ElementClasses(const Grid<3>&, const SolidPoints<3>&,
                                        const PointsByElement&);

template std::vector<double> sums_in_elements(const Grid<2>&, const SolidPoints<2>&,
                                              const std::vector<double>&, double);
template std::vector<double> sums_in_elements(const Grid<3>&, const SolidPoints<3>&,
                                              const std::vector<double>&, double);

}  // namespace suffuse
