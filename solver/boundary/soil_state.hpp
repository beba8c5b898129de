#pragma once

/// The soil at one time of a run, from a snapshot.

#include <string>
#include <vector>

#include "solid/skeleton.hpp"
#include "solid/solid_points.hpp"

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

}  // namespace suffuse
