#pragma once

/// The soil at one time of a run, from a snapshot.

#include <map>
#include <string>
#include <vector>

#include "boundary/loads.hpp"
#include "solid/skeleton.hpp"
#include "solid/solid_points.hpp"

namespace suffuse {

/// State on which the factor of safety depends, in addition to the strength of the soils. It does
/// not depend on stresses.
template <int Dim>
struct SoilState {
  double time = 0.0;                 ///< s; for the loads on the boundaries
  SolidPoints<Dim> points;           ///< with places and volumes; without stress
  std::vector<int> region;           ///< per point: region of the mesh that its soil comes from
  std::vector<double> solid_volume;  ///< per point, m3
  std::vector<double> erodible;      ///< per point: erodible volume at the start, m3
  std::vector<double> fines_left;    ///< per point: remaining share of the erodible fines
  std::vector<double> pressure;      ///< pore pressure on the solid, per element, Pa
  std::vector<double> liquid_mass;   ///< per volume of soil and element, kg/m3
  /// Surfaces with a traction, moved with the soil, by the name of their boundary.
  std::map<std::string, LoadedSurface<Dim>> surfaces;
};

/// Reads the state from the fields of a snapshot (`soil_fields`). Points of a rigid skeleton are at
/// their places in the case. The run has started with the points of the case.
/// \param soils  with the points of the case
/// Throws FileError if the snapshot has another number of points or elements.
template <int Dim>
SoilState<Dim> soil_state(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                          const Snapshot& snapshot);

/// Sets the pressures and masses of the liquid for the points of `state`.
template <int Dim>
void take_liquid(const SoilMap<Dim>& soils, const Snapshot& snapshot, SoilState<Dim>& state);

/// Names of the fields of elements and solid points that `soil_state` needs; more of points if the
/// skeleton moves. `saturation` of elements may be missing.
struct SoilFields {
  std::vector<const char*> cell;
  std::vector<const char*> solid;
};
SoilFields soil_fields(bool moves);

}  // namespace suffuse
