#pragma once

/// Spreads points that lie too close together.

#include "equilibrium/solid_points.hpp"
#include "equilibrium/supports.hpp"

namespace suffuse {

/// Soil that falls crowds its points: laws keep the volume of each, but nothing keeps the points
/// from sharing the room of one. Where the volumes around a node exceed its share of the mesh by
/// more than a tenth, points are moved along the gradient of the excess, until it is small or ten
/// times (the mean of the correction of Baumgarten and Kamrin, Int. J. Numer. Methods Eng. 124
/// (2023) 4131). Volumes, stress and velocities of points do not change, and no point leaves the
/// mesh.
template <int Dim>
void space_points(const Grid<Dim>& grid, const Supports<Dim>& supports, SolidPoints<Dim>& points);

}  // namespace suffuse
