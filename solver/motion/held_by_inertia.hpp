#pragma once

/// How soil with inertia gives way to pressures within a step, for the iteration of flow and motion
/// (docs/theory.md, "Inertia of the soil").

#include <vector>

#include "grid/grid.hpp"

namespace suffuse {

/// Compressibility of each element, m3/Pa: that of drained soil in series with inertia. Nodes of
/// mass M_i that nothing else holds give way to a pressure p by p V_e grad N_i dt^2/M_i.
/// \param drained    per element, m3/Pa
/// \param node_mass  kg; a node at the surface may have next to none
/// \param duration   of the step, s
template <int Dim>
std::vector<double> held_compressibility(const Grid<Dim>& grid, std::vector<double> drained,
                                         const std::vector<double>& node_mass, double duration);

/// Mobility of each element by inertia, dt/rho, m3 s/kg (S8); 0 where stiffness decides.
template <int Dim>
std::vector<double> held_mobility(const Grid<Dim>& grid, const std::vector<double>& drained,
                                  const std::vector<double>& node_mass, double duration);

}  // namespace suffuse
