#pragma once

/// Response of soil with inertia to pressures within a step, for the iteration of flow and motion
/// (docs/theory/moving-soil.md, "Inertia of the soil").

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// Compressibility of each element, m3/Pa: that of drained soil in series with inertia. A free node
/// of mass M_i moves by p V_e grad N_i dt^2/M_i under a pressure p.
/// \param drained    per element, m3/Pa
/// \param node_mass  kg; may be tiny at the surface
/// \param duration   of the step, s
template <int Dim>
std::vector<double> held_compressibility(const Grid<Dim>& grid, std::vector<double> drained,
                                         const std::vector<double>& node_mass, double duration);

/// Mobility of each element by inertia, dt/rho, m3 s/kg (S8); 0 where stiffness governs.
template <int Dim>
std::vector<double> held_mobility(const Grid<Dim>& grid, const std::vector<double>& drained,
                                  const std::vector<double>& node_mass, double duration);

}  // namespace suffuse
