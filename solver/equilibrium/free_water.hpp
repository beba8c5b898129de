#pragma once

/// Free water beside the soil, which presses on its surface.

#include <array>
#include <vector>

#include "equilibrium/solid_points.hpp"
#include "equilibrium/supports.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Whether the scene has a region of free water: then elements that soil has left hold it too.
template <int Dim>
bool has_free_water(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

/// Adds what free water in elements without soil does to the nodes of the soil, N: such an element
/// is one of a mixture without stress, p V_e grad N + rho V_e g/(Dim + 1), in its place at the
/// start of the step. Elements at the surface of the soil are filled up with water. \param
/// soil_volume  per element, m3 \param pressure     per element, Pa \param liquid_mass  per volume
/// of soil and element, kg/m3 \param gravity      m/s2
template <int Dim>
void add_free_water(const Grid<Dim>& grid, const PointsByElement& sorted,
                    const std::vector<double>& soil_volume, const std::vector<double>& pressure,
                    const std::vector<double>& liquid_mass, const std::array<double, 3>& gravity,
                    NodeVectors<Dim>& loads);

}  // namespace suffuse
