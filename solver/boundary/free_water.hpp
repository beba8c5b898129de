#pragma once

/// Free water next to the soil, which presses on its surface.

#include <array>
#include <vector>

#include "boundary/nodal_loads.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Whether the scene has a region of free water; elements that soil has left then hold it too.
template <int Dim>
bool has_free_water(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

/// Adds the forces of free water in elements without soil on the soil, N: p V_e grad N
/// + rho V_e g/(Dim + 1), in their place at the start of the step. In elements partly filled with
/// soil, water fills the rest.
/// \param soil_volume  per element, m3; `pressure` per element, Pa
/// \param liquid_mass  per volume of soil and element, kg/m3; `gravity` in m/s2
template <int Dim>
void add_free_water(const Grid<Dim>& grid, const PointsByElement& sorted,
                    const std::vector<double>& soil_volume, const std::vector<double>& pressure,
                    const std::vector<double>& liquid_mass, const std::array<double, 3>& gravity,
                    NodalLoads<Dim>& loads);

/// Adds the water that fills the rest of elements partly filled with soil, and moves with it, to
/// the masses of nodes, kg.
/// \param soil_volume, liquid_mass  see `add_free_water`
template <int Dim>
void add_free_water_mass(const Grid<Dim>& grid, const PointsByElement& sorted,
                         const std::vector<double>& soil_volume,
                         const std::vector<double>& liquid_mass, std::vector<double>& mass);

}  // namespace suffuse
