#pragma once

/// Soil that moves as a run has left it, from which another run starts on the same mesh: a stage of
/// construction.

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "boundary/loads.hpp"
#include "motion/crossing_forces.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
struct MovedSoil {
  std::vector<char> has_soil = {};  ///< per region of the mesh: whether the scene gives it a soil
  SolidState state;
  SolidPoints<Dim> points;               ///< sorted by element
  std::vector<PointSkeleton> skeleton;   ///< per point: its law at the end of the run
  std::vector<int> region;               ///< per point: region that it comes from
  std::vector<double> initial_porosity;  ///< per point, of the first of all runs
  std::vector<double> initial_erodible;  ///< per point, m3, of the first of all runs
  std::vector<double> element_solid;     ///< m3
  std::vector<double> pressure;          ///< of the pores at the last equilibrium, per element, Pa
  CrossingForces<Dim> crossing_forces;
  bool has_inertia = false;
  double held_share = 0.0;  ///< see MovingSkeleton::end_inertia
  /// Surfaces with a traction, by the name of their boundary.
  std::map<std::string, LoadedSurface<Dim>> surfaces;

  /// What a run changes, in the order of MovingSkeleton::lasting.
  auto lasting() {
    return std::tie(state, points, region, initial_porosity, initial_erodible, element_solid,
                    pressure, crossing_forces, held_share);
  }
};

}  // namespace suffuse
