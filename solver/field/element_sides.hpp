#pragma once

/// Neighbours of elements and their common nodes, for the transport of a concentration that is
/// linear in each element. Side k of an element is opposite to vertex k; its nodes are the vertices
/// that follow k, in that order.

#include <array>
#include <cstdint>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "grid/element_field.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// Vertex `a` of side k.
template <int Dim>
constexpr int side_vertex(int k, int a) {
  return (k + 1 + a) % (Dim + 1);
}

/// Places of the upwind concentrations at the nodes of each side, in a list of the values at the
/// vertices of all elements and then the entering value of each outer face.
template <int Dim>
using UpwindPlaces = std::array<std::array<int, Dim>, Dim + 1>;

template <int Dim>
class ElementSides {
 public:
  explicit ElementSides(const Grid<Dim>& grid);

  struct Sides {
    /// Element across the side; at the outer boundary -1 minus the index of the outer face; at the
    /// fringe of a rank's part, whose values come from other ranks, the element itself.
    std::array<int, Dim + 1> neighbour;
    /// Indices of the side's nodes among the neighbour's vertices.
    std::array<std::array<std::uint8_t, Dim>, Dim + 1> theirs;
  };
  [[nodiscard]] const Sides& of(int element) const { return sides_[element]; }
  /// Faces of the outer boundary, without leaky walls.
  [[nodiscard]] const std::vector<int>& outer_faces() const { return outer_faces_; }

  /// Number of values at the vertices of all elements and at outer faces.
  [[nodiscard]] std::size_t value_count() const {
    return (Dim + 1) * sides_.size() + outer_faces_.size();
  }
  /// Sets the values at outer faces to the concentrations that enter there.
  void set_entering(const std::vector<FaceCondition>& conditions,
                    std::vector<double>& at_vertices) const;
  [[nodiscard]] UpwindPlaces<Dim> upwind_places(int element,
                                                const ElementValues<Dim>& outflow) const;
  /// Outflow through each side of an element, from `face_volume` along each face's normal.
  [[nodiscard]] ElementValues<Dim> outflow(int element,
                                           const std::vector<double>& face_volume) const {
    ElementValues<Dim> result;
    for (int k = 0; k <= Dim; ++k) {
      result[k] = grid_.element_face_sign[element][k] * face_volume[grid_.element_face[element][k]];
    }
    return result;
  }
  /// Sets `result` to the volume through each face along its normal, from the outflow through the
  /// sides of all elements.
  void at_faces(const ElementField<Dim>& outflow, int threads, std::vector<double>& result) const;

 private:
  const Grid<Dim>& grid_;
  std::vector<Sides> sides_;  ///< per element
  std::vector<int> outer_faces_;
};

template <int Dim>
inline UpwindPlaces<Dim> ElementSides<Dim>::upwind_places(int element,
                                                          const ElementValues<Dim>& outflow) const {
  constexpr int vertices = Dim + 1;
  const Sides& sides = sides_[element];
  const auto elements = static_cast<int>(sides_.size());
  UpwindPlaces<Dim> result;
  for (int k = 0; k <= Dim; ++k) {
    const int neighbour = sides.neighbour[k];
    for (int a = 0; a < Dim; ++a) {
      result[k][a] = outflow[k] >= 0.0 ? vertices * element + side_vertex<Dim>(k, a)
                     : neighbour >= 0  ? vertices * neighbour + sides.theirs[k][a]
                                       : vertices * elements - 1 - neighbour;
    }
  }
  return result;
}

/// The node at the place of `node` across a face: `node` itself, except at a leaky wall.
template <int Dim>
int node_beyond(const Grid<Dim>& grid, int face, int node);

}  // namespace suffuse
