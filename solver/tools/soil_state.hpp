#pragma once

/// The soil at one time of a run, from a snapshot, and its factor of safety at that time.

#include <algorithm>
#include <string>
#include <vector>

#include "solid/skeleton.hpp"
#include "tools/strength_reduction.hpp"

namespace suffuse {

/// State on which the factor of safety depends, in addition to the strength of the soils. It does
/// not depend on stresses.
template <int Dim>
struct SoilState {
  double time = 0.0;                 ///< s; for the loads on the boundaries
  SolidPoints<Dim> points;           ///< with places and volumes; without stress
  std::vector<int> id;               ///< per point: its number among the points of the case
  std::vector<double> solid_volume;  ///< per point, m3
  std::vector<double> fines_left;    ///< per point: remaining share of the erodible fines
  std::vector<double> pressure;      ///< pore pressure on the solid, per element, Pa
  std::vector<double> liquid_mass;   ///< per volume of soil and element, kg/m3
};

/// Reads the state from the fields of a snapshot (`soil_fields`). Points of a rigid skeleton are at
/// their places in the case.
/// \param soils  with the points of the case
/// Throws FileError if the snapshot has another number of points or elements.
template <int Dim>
SoilState<Dim> soil_state(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                          const Snapshot& snapshot);

/// Names of the fields of elements and solid points that `soil_state` needs; more of points if the
/// skeleton moves. `saturation` of elements may be missing.
struct SoilFields {
  std::vector<const char*> cell;
  std::vector<const char*> solid;
};
SoilFields soil_fields(bool moves);

/// Soil that may fail in strength reduction.
struct FailingSoil {
  /// Only soil of these regions fails, other soil is elastic; empty: all regions.
  std::vector<std::string> regions;
  /// Soil nearer to its surface (`depths_below_surface`), m, gets an additional cohesion of half of
  /// its unit weight times this depth, which is not divided. That is the largest shear stress that
  /// a layer of this thickness has below it on a slope of any angle, so that no thinner body
  /// slides.
  double depth = 0.0;

  [[nodiscard]] bool includes(const std::string& region) const {
    return regions.empty() || std::ranges::count(regions, region) > 0;
  }
};

/// Largest divisor of the strength of the soils for which this state has an equilibrium, under the
/// weight and the loads of the scene at that time. Loaded surfaces are moved with the soil. Throws
/// NumericalError when nothing holds the soil.
template <int Dim>
SafetyFactor find_safety_factor(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const SoilState<Dim>& state, const FailingSoil& failing,
                                int threads, const StrengthReductionLimits& limits = {});

}  // namespace suffuse
