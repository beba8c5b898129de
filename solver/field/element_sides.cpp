#include "field/element_sides.hpp"

#include <algorithm>

#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Index of a node among the vertices of an element.
template <int Dim>
std::uint8_t position_in(const std::array<int, Dim + 1>& vertices, int node) {
  return static_cast<std::uint8_t>(std::find(vertices.begin(), vertices.end(), node) -
                                   vertices.begin());
}

}  // namespace

template <int Dim>
int node_beyond(const Grid<Dim>& grid, int face, int node) {
  const int partner = grid.face_partner[face];
  if (partner < 0) return node;
  const auto& nodes = grid.mesh.nodes;
  return *std::ranges::min_element(grid.face_nodes[partner], {}, [&](int other) {
    return (nodes[other] - nodes[node]).squaredNorm();
  });
}

template <int Dim>
ElementSides<Dim>::ElementSides(const Grid<Dim>& grid)
    : grid_(grid), sides_(grid.mesh.elements.size()) {
  std::vector<int> outer(grid.face_count(), -1);
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_border(f)) continue;
    outer[f] = static_cast<int>(outer_faces_.size());
    outer_faces_.push_back(f);
  }
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    Sides& sides = sides_[e];
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid.element_face[e][k];
      const int next = grid.beyond(f, e);
      sides.neighbour[k] = next >= 0 ? next : outer[f] >= 0 ? -1 - outer[f] : e;
      sides.theirs[k] = {};
      if (next < 0) continue;
      for (int a = 0; a < Dim; ++a) {
        const int node = grid.mesh.elements[e][side_vertex<Dim>(k, a)];
        sides.theirs[k][a] =
            position_in<Dim>(grid.mesh.elements[next], node_beyond<Dim>(grid, f, node));
      }
    }
  }
}

template <int Dim>
void ElementSides<Dim>::set_entering(const std::vector<FaceCondition>& conditions,
                                     std::vector<double>& at_vertices) const {
  const std::size_t first = (Dim + 1) * sides_.size();
  for (std::size_t o = 0; o < outer_faces_.size(); ++o) {
    at_vertices[first + o] = conditions[outer_faces_[o]].concentration;
  }
}

template <int Dim>
void ElementSides<Dim>::at_faces(const ElementField<Dim>& outflow, int threads,
                                 std::vector<double>& result) const {
  result.resize(grid_.face_count());
  for_each_index(grid_.mesh.element_count(), threads, [&](int e) {
    for (int k = 0; k <= Dim; ++k) {
      if (grid_.element_face_sign[e][k] < 0.0) continue;
      result[grid_.element_face[e][k]] = outflow[e][k];
    }
  });
  grid_.face_rows().exchange(result);
}

template class ElementSides<2>;
template int node_beyond(const Grid<2>&, int, int);
template class ElementSides<3>;
template int node_beyond(const Grid<3>&, int, int);

}  // namespace suffuse
