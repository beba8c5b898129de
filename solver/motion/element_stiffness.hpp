#pragma once

/// Properties of elements by the points in them: stiffness, diffusion of pressure, and the share
/// that soil fills.

#include <vector>

#include "equilibrium/equilibrium.hpp"
#include "solid/element_classes.hpp"
#include "solid/skeleton.hpp"
#include "solid/solid_points.hpp"

namespace suffuse {

/// E_oed per point, Pa; 0 if it does not move.
template <int Dim>
std::vector<double> oedometer_moduli(const SoilMap<Dim>& soils,
                                     const std::vector<PointSkeleton>& skeleton);

/// V_e / E_oed, m3/Pa; in free water next to soil, with E_oed of the softest soil; 0 elsewhere
/// without moving soil.
/// \param modulus  E_oed per point, Pa; 0 if the point does not move
template <int Dim>
std::vector<double> drained_compressibility(const Grid<Dim>& grid, const SolidPoints<Dim>& points,
                                            const std::vector<double>& modulus,
                                            bool has_free_water);

/// c_v = k E_oed / gamma_w per element, with the least k of its points, m2/s; 0 without moving
/// soil.
/// \param compressibility  V_e / E_oed per element, m3/Pa
/// \param porosity         per point, at the start and now
template <int Dim>
std::vector<double> diffusivity(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const PointsByElement& sorted, std::vector<double> compressibility,
                                const std::vector<double>& initial_porosity,
                                const std::vector<double>& porosity);

/// Volumes of soil and of its solid, m3 per element.
struct SoilVolumes {
  /// 1 - solid/soil; 1 without soil.
  [[nodiscard]] double porosity(std::size_t element) const {
    return soil[element] > 0.0 ? 1.0 - solid[element] / soil[element] : 1.0;
  }

  std::vector<double> soil;
  std::vector<double> solid;
};

/// Share of each element that soil fills, and the porosity of that soil. An element inside the soil
/// has the porosity of its own points, which no motion through elements smears.
/// \param own       of the points of each element
/// \param smoothed  of the points, smoothed by nodes
/// \param element_porosity  that motion has carried between elements
std::vector<SoilFilling> soil_filling(const ElementClasses& classes, const SoilVolumes& own,
                                      const SoilVolumes& smoothed,
                                      const std::vector<double>& element_porosity);

}  // namespace suffuse
