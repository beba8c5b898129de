#pragma once

/// Motion of solid points with the nodes of their elements at the end of a step.

#include "equilibrium/equilibrium.hpp"

namespace suffuse {

/// Moves the points, finds their new elements, and updates volume, elastic deformation and plastic
/// strain. The body's order of points and its classes are outdated then: make them again.
/// \param displacement  of the nodes over the step, m
/// \param law_factors   `Equilibrium::law_factors` of the displacement: volumes follow it too
/// Throws NumericalError, with point and place, if a point would leave the mesh; the points do not
/// change then.
template <int Dim>
void move_points(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                 const NodeVectors<Dim>& displacement, SolidPoints<Dim>& points, int threads,
                 const std::vector<double>& law_factors);

/// Largest displacement of an element's node over the smallest height of the element, among
/// elements with points: a step should stay below 1/4.
template <int Dim>
double largest_travel(const Grid<Dim>& grid, const PointsByElement& sorted,
                      const NodeVectors<Dim>& displacement);

}  // namespace suffuse
