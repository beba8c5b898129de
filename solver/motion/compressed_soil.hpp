#pragma once

/// Refuses steps that compress soil until its grains leave no pores: no law of the skeleton
/// stiffens then.

#include <vector>

#include "equilibrium/equilibrium.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// A step of the soil, before its points have moved.
template <int Dim>
struct SoilStep {
  const SolidPoints<Dim>& points;
  std::vector<double> solid_volume;             ///< per point, m3
  const std::vector<double>& initial_porosity;  ///< per point
  Increments<Dim> increments;                   ///< that laws see over the step
  double end;                                   ///< s
};

/// Throws EquilibriumLost if the step leaves a point less than 1 % of its pores at the start.
template <int Dim>
void refuse_compressed(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const SoilStep<Dim>& step);

/// Throws NumericalError if solid, m3 per element, fills an element at `time`, s, or is negative.
template <int Dim>
void refuse_impossible(const Grid<Dim>& grid, const std::vector<double>& solid_volume, double time);

}  // namespace suffuse
