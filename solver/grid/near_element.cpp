#include "grid/near_element.hpp"

#include <algorithm>

#include "grid/section_line.hpp"

namespace suffuse {
namespace {

/// A place outside an element by less than this, in barycentric coordinates, belongs to it, so that
/// a point on a face does not leave the mesh by round-off.
constexpr double on_face = 1e-12;
/// Soil may rise above the border of the mesh by this share of the height of the element there, to
/// which its points then still belong.
constexpr double over_border = 0.5;

template <int Dim>
double least_barycentric(const Grid<Dim>& grid, int element, const Vector<Dim>& x) {
  return std::ranges::min(barycentric(grid.mesh, element, x));
}

/// The element with a node of this one that holds a place; -1 if there is none.
template <int Dim>
int neighbour_at(const Grid<Dim>& grid, int element, const Vector<Dim>& x) {
  for (const int i : grid.mesh.elements[element]) {
    for (int k = grid.node_element_begin[i]; k < grid.node_element_begin[i + 1]; ++k) {
      if (least_barycentric(grid, grid.node_element[k], x) >= -on_face) return grid.node_element[k];
    }
  }
  return -1;
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
    if (next < 0) break;  // outside, or beyond an inward corner of the border
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

template int element_at(const Grid<2>&, int, const Vector<2>&);
template int element_at(const Grid<3>&, int, const Vector<3>&);

}  // namespace suffuse
