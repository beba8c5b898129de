#pragma once

/// Spreads points that lie too close together.

#include "solid/solid_points.hpp"
#include "solid/supports.hpp"

namespace suffuse {

/// Soil that falls crowds its points: laws keep the volume of each, but nothing keeps the points
/// from sharing the room of one. Where the smoothed volumes of points exceed that of an element by
/// more than a quarter, points are moved against the gradient of the excess, until it is small, or
/// ten times; each time no node by more than the soil has moved there, so that soil at rest is left
/// alone. (Baumgarten and Kamrin, Int. J. Numer. Methods Eng. (2023), doi 10.1002/nme.7217, correct
/// places of points in each step for the same reason.) Volumes, stress and velocities of points do
/// not change, and no point leaves the mesh.
/// \param displacement  of the nodes in the step, m
template <int Dim>
void space_points(const Grid<Dim>& grid, const Supports<Dim>& supports,
                  const NodeVectors<Dim>& displacement, SolidPoints<Dim>& points);

}  // namespace suffuse
