#pragma once

/// The stress at the start of a run: an equilibrium without displacement of the points.

#include <array>
#include <optional>

#include "equilibrium/step_equilibrium.hpp"

namespace suffuse {

/// Loads on the soil at the start.
template <int Dim>
struct StartLoads {
  NodeVectors<Dim> forces;          ///< on the nodes, N
  std::vector<Vector<Dim>> weight;  ///< of soil with its water, per element, N/m3
  std::vector<double> pressure;     ///< of the pores, per element, Pa
  std::array<double, 3> gravity;    ///< m/s2: its direction is the vertical
  /// K_0, horizontal over vertical effective stress; without it, the stress results from applying
  /// all loads at once.
  std::optional<double> earth_pressure;
};

/// Whether the soil has an equilibrium at the start.
struct StartStress {
  bool stands = false;
  int worst_node = -1;  ///< with the largest unbalanced force; -1: not known
};

/// Sets the stress of the points. Soil is elastic first, then yields; if it cannot carry the
/// elastic stress, it takes the loads in parts, or yields slowly in a pseudo-time. With K_0, the
/// vertical stress is that of elastic soil with Poisson's ratio K_0/(1 + K_0), which has that ratio
/// of stresses under level ground; the horizontal stress is K_0 times as much in all directions,
/// and the soil finds its equilibrium from there. Volumes and places do not change; plastic strains
/// count from here. Without an equilibrium points get the elastic stress as far as they can bear
/// it. `skeleton` per point.
template <int Dim>
StartStress find_start_stress(const Grid<Dim>& grid, const std::vector<PointSkeleton>& skeleton,
                              const Supports<Dim>& supports, const StartLoads<Dim>& loads,
                              SolidPoints<Dim>& points, int threads);

}  // namespace suffuse
