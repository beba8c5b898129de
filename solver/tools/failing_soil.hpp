#pragma once

/// The factor of safety of the soil at one time of a run, or of a part of it.

#include <algorithm>
#include <string>
#include <vector>

#include "boundary/soil_state.hpp"
#include "tools/strength_reduction.hpp"

namespace suffuse {

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

/// Displacements in the trials of strength reduction.
enum class Displacements {
  linear,    ///< those of a run
  quadratic  ///< nearer to the limit on coarse meshes, and slower: see `QuadraticEquilibrium`
};

/// Largest divisor of the strength of the soils for which this state has an equilibrium, under the
/// weight and the loads of the scene at that time. Loaded surfaces are moved with the soil. Throws
/// NumericalError when nothing holds the soil.
template <int Dim>
SafetyFactor find_safety_factor(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const SoilState<Dim>& state, const FailingSoil& failing,
                                Displacements displacements, int threads,
                                const StrengthReductionLimits& limits = {});

}  // namespace suffuse
