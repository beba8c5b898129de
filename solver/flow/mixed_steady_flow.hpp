#pragma once

/// Steady Darcy flow by mixed finite elements: Crouzeix-Raviart face pressures, from which
/// Raviart-Thomas fluxes follow (Marini, SIAM J. Numer. Anal. 22 (1985) 493). Follows any flow on
/// any mesh, and so tells where the nodal scheme cannot.

#include <vector>

#include "flow/face_conditions.hpp"
#include "flow/flow.hpp"
#include "grid/grid.hpp"

namespace suffuse {

/// Darcy flux at the centroid of each element, m/s. Prescribed velocities count with the porosity
/// of their element. Throws NumericalError when the factorisation fails.
template <int Dim>
std::vector<Vector<Dim>> mixed_steady_flux(const Grid<Dim>& grid,
                                           const std::vector<FaceCondition>& conditions,
                                           const FlowCoefficients<Dim>& coefficients,
                                           const Vector<Dim>& gravity);

}  // namespace suffuse
