#pragma once

/// Moves points through a mesh with a velocity that is linear in each element, from face to face.

#include <vector>

#include "case/mesh.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// Where a point is: barycentric coordinates in the element that holds it.
template <int Dim>
struct PointPlace {
  int element;
  std::array<double, Dim + 1> barycentric;

  [[nodiscard]] Vector<Dim> position(const Mesh<Dim>& mesh) const {
    Vector<Dim> x = Vector<Dim>::Zero();
    for (int a = 0; a <= Dim; ++a) x += barycentric[a] * mesh.nodes[mesh.elements[element][a]];
    return x;
  }
};

/// A flux that is continuous and linear in each element, and what divides it there: points move
/// with flux / porosity. At a jump of porosity the velocity jumps with it, on the face and nowhere
/// else.
template <int Dim>
struct WalkField {
  const std::vector<Vector<Dim>>& node_flux;  ///< m/s
  const std::vector<double>& porosity;        ///< per element
  const std::vector<unsigned char>&
      open_face;  ///< per face: an outer face that points may leave by
};

/// Walks `place` for `duration` seconds. Within an element the path is straight, at the velocity of
/// its midpoint (second order). At an impervious face the point slides along it. Returns the outer
/// face by which it left, with the place on that face, or -1. Throws NumericalError when the walk
/// does not come to an end; `id` is for the message.
template <int Dim>
int walk(const Grid<Dim>& grid, const WalkField<Dim>& field, PointPlace<Dim>& place,
         double duration, long id);

/// Most that one barycentric coordinate in any element changes per second, 1/s: its inverse is
/// about the time in which a point crosses the element.
template <int Dim>
double crossing_rate(const Grid<Dim>& grid, const WalkField<Dim>& field, int element);

}  // namespace suffuse
