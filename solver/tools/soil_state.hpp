#pragma once

/// The soil at one moment of a run, as a snapshot has it, and its factor of safety then.

#include "solid/skeleton.hpp"
#include "tools/strength_reduction.hpp"

namespace suffuse {

/// What the factor of safety depends on, in addition to the strength of the soils. Stresses are not
/// among it: the factor does not depend on them.
template <int Dim>
struct SoilState {
  double time = 0.0;                 ///< s: when loads act on the boundaries
  SolidPoints<Dim> points;           ///< in their places, with their volumes; without stress
  std::vector<int> id;               ///< per point: its number among the points of the case
  std::vector<double> solid_volume;  ///< per point, m3
  std::vector<double> fines_left;    ///< per point: share of the erodible fines of the start
  std::vector<double> pressure;      ///< of the pores on the solid, per element, Pa
  std::vector<double> liquid_mass;   ///< per volume of soil and element, kg/m3
};

/// Reads it from the fields of a snapshot (`soil_fields`). That of a rigid skeleton has the points
/// where the case has them.
/// \param soils  with the points of the case
/// Throws FileError where the snapshot has another number of points or elements.
template <int Dim>
SoilState<Dim> soil_state(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                          const Snapshot& snapshot);

/// Names of the fields that `soil_state` needs: of elements and solid points, and of those more
/// where the skeleton moves. `saturation` of elements may be missing.
struct SoilFields {
  std::vector<const char*> cell;
  std::vector<const char*> solid;
};
SoilFields soil_fields(bool moves);

/// Largest divisor of the strength of the soils that leaves this state an equilibrium, under their
/// weight and the loads of the scene at that time. Loaded surfaces have moved with the soil. Throws
/// NumericalError when nothing holds the soil.
template <int Dim>
SafetyFactor find_safety_factor(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                const SoilState<Dim>& state, int threads,
                                const StrengthReductionLimits& limits = {});

}  // namespace suffuse
