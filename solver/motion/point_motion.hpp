#pragma once

/// Motion of solid points with the nodes of their elements at the end of a step.

#include "equilibrium/equilibrium.hpp"

namespace suffuse {

/// Moves the points, finds their new elements, and updates volume, elastic deformation and plastic
/// strain. The body's order of points and its classes are outdated then: make them again.
/// \param displacement  of the nodes over the step, m
/// \param increments    that laws see (`Equilibrium::law_increments`); volumes follow them too,
///                      up to four times those at the start
/// Throws NumericalError, with point and place, if a point would leave the mesh; the points do not
/// change then.
template <int Dim>
void move_points(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                 const NodeVectors<Dim>& displacement, const Increments<Dim>& increments,
                 SolidPoints<Dim>& points, int threads);

/// Largest displacement of a point over the smallest height of its element: a step should stay
/// below 1/4. Nodes outside the soil, which hardly carry any of it, may move farther.
template <int Dim>
double largest_travel(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                      const NodeVectors<Dim>& displacement);

}  // namespace suffuse
