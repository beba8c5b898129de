#pragma once

/// Which elements share their dilatation.

#include "equilibrium/equilibrium.hpp"

namespace suffuse {

/// Volumes of the soil, m3, of elements that share their dilatation as they would lock; 0 of
/// others.
///
/// A patch has one mean effective stress, and the strength of soil with friction grows with that.
/// At a free surface, where stress begins at zero, single patches of triangles can fail on coarse
/// meshes: a dry slope of factor 1.8 had 1.4. Triangles at a surface of soil with friction
/// therefore keep their own ratio. Tetrahedra there share it: without that they are far too stiff.
template <int Dim>
std::vector<double> sharing_volumes(const SolidBody<Dim>& body, const Supports<Dim>& supports,
                                    std::vector<double> soil_volume);

}  // namespace suffuse
