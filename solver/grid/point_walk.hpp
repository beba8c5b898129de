#pragma once

/// Moves points through a mesh, from face to face, with a velocity that is linear in each element.

#include <vector>

#include "grid/point_place.hpp"

namespace suffuse {

/// A flux that is continuous and linear in each element, and the porosity: points move with flux /
/// porosity. At a jump of porosity the velocity jumps on the face only.
template <int Dim>
struct WalkField {
  const std::vector<Vector<Dim>>& node_flux;  ///< m/s
  const std::vector<double>& porosity;        ///< per element
  const std::vector<unsigned char>&
      open_face;  ///< per face: an outer face that points may leave by
};

/// Walks `place` for `duration` seconds. Within an element the path is straight, at the velocity of
/// its midpoint (second order). The point slides along impervious faces. Returns the outer face by
/// which it left, with the place on that face, or -1. Throws NumericalError if the point crosses
/// faces without end; `id` is for the message.
template <int Dim>
int walk(const Grid<Dim>& grid, const WalkField<Dim>& field, PointPlace<Dim>& place,
         double duration, long id);

/// Largest rate of change of a barycentric coordinate in the element, 1/s: its inverse is about the
/// time in which a point crosses the element.
template <int Dim>
double crossing_rate(const Grid<Dim>& grid, const WalkField<Dim>& field, int element);

}  // namespace suffuse
