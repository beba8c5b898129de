#pragma once

/// The stress at the start of a run: an equilibrium that leaves the points where they are.

#include <array>
#include <optional>

#include "equilibrium/step_equilibrium.hpp"

namespace suffuse {

/// What the soil is in equilibrium with at the start.
template <int Dim>
struct StartLoads {
  NodeVectors<Dim> forces;        ///< on the nodes, N
  std::vector<double> pressure;   ///< of the pores, per element, Pa
  std::array<double, 3> gravity;  ///< m/s2: its direction is the vertical
  /// K_0, horizontal over vertical effective stress; without it, the stress of soil that has taken
  /// its loads all at once.
  std::optional<double> earth_pressure;
};

/// Whether the soil stands at the start.
struct StartStress {
  bool stands = false;
  int worst_node = -1;  ///< at which forces are out of balance most; -1: not known
};

/// Gives the points this stress. First the soil is elastic, then it yields; where it cannot carry
/// the elastic stress, it takes the loads in parts, or yields slowly, through a pseudo-time. With
/// K_0, the vertical stress is that of elastic soil with Poisson's ratio K_0/(1 + K_0), which has
/// that ratio of stresses under level ground, and the horizontal one K_0 times as much in all
/// directions; then the soil finds its equilibrium from there. Volumes and places do not change,
/// and plastic strains count from here. Where there is no equilibrium points then have the stress
/// of elastic soil, as far as they can bear it. \param skeleton  per point
template <int Dim>
StartStress find_start_stress(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                              const Supports<Dim>& supports, const StartLoads<Dim>& loads,
                              SolidPoints<Dim>& points, int threads);

}  // namespace suffuse
