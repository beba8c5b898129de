#pragma once

/// Solid points move with the nodes of their elements at the end of a step.

#include "equilibrium/equilibrium.hpp"

namespace suffuse {

/// Moves the points, gives them the elements that hold them then, and updates volume, elastic
/// deformation and plastic strain. The body's order of points and its classes are those of before:
/// make them again.
/// \param displacement  of the nodes over the step, m
/// Throws NumericalError when a point would leave the mesh, with the point and the place; the
/// points are then as they were.
template <int Dim>
void move_points(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                 const NodeVectors<Dim>& displacement, SolidPoints<Dim>& points, int threads);

/// Largest displacement of a node over the height of the lowest element at it, of the nodes of
/// elements with points: a step should stay below 1/4.
template <int Dim>
double largest_travel(const Grid<Dim>& grid, const PointsByElement& sorted,
                      const NodeVectors<Dim>& displacement);

}  // namespace suffuse
