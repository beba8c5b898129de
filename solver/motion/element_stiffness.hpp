#pragma once

/// What the points in an element make of it: how stiff it is, how fast pressures spread in it, how
/// far soil fills it.

#include <vector>

#include "equilibrium/element_classes.hpp"
#include "equilibrium/solid_points.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// V_e / E_oed, m3/Pa, in free water beside soil that of the softest soil; 0 elsewhere without soil
/// that moves.
/// \param modulus  E_oed per point, Pa; 0 where it does not move
template <int Dim>
std::vector<double> drained_compressibility(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                            const std::vector<double>& modulus,
                                            bool has_free_water);

/// c_v = k E_oed / gamma_w per element, with the least k of its points, m2/s; 0 without soil that
/// moves.
/// \param compressibility  V_e / E_oed per element, m3/Pa
/// \param porosity         per point, at the start and now
template <int Dim>
std::vector<double> diffusivity(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const PointsByElement& sorted, std::vector<double> compressibility,
                                const std::vector<double>& initial_porosity,
                                const std::vector<double>& porosity);

/// How far soil fills each element.
/// \param volume, solid  of the points, smoothed, m3 per element
template <int Dim>
std::vector<SoilFilling> soil_filling(const Grid<Dim>& grid, const ElementClasses& classes,
                                      const std::vector<double>& volume,
                                      const std::vector<double>& solid);

}  // namespace suffuse
