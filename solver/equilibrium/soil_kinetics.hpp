#pragma once

/// How fast soil moves, and when that is rest or a slide (docs/theory/moving-soil.md, "When soil
/// fails").

#include <cmath>

namespace suffuse {

/// Mass, load and height that the motion of soil is compared with.
struct SoilExtent {
  double mass = 0.0;    ///< kg
  double load = 0.0;    ///< its weight; without gravity, its share of the loads of all nodes, N
  double height = 0.0;  ///< along gravity, m

  /// Time in which the load would move the soil by its height, s.
  [[nodiscard]] double time_of_fall() const { return std::sqrt(2.0 * height * mass / load); }
};

/// Kinetics of soil in a step.
struct SoilKinetics {
  double energy = 0.0;         ///< J
  double inertia_share = 0.0;  ///< forces of inertia over all loads
  SoilExtent soil = {};
  double load_share = 1.0;  ///< the loads that motion is compared with over all loads

  /// Whether soil is slow enough for equilibrium: inertia carries less than 1 % of its loads, and
  /// the kinetic energy is less than 1e-6 of the loads times the height.
  [[nodiscard]] bool is_rest() const {
    constexpr double small_share = 1e-2;
    constexpr double small_energy = 1e-6;
    return inertia_share < small_share * load_share &&
           energy < small_energy * soil.load * soil.height;
  }
  /// Whether soil in equilibrium is so fast that inertia governs how far it moves: the kinetic
  /// energy is more than 1e-4 of the loads times the height.
  [[nodiscard]] bool is_slide() const {
    constexpr double large_energy = 1e-4;
    return energy > large_energy * soil.load * soil.height;
  }
};

}  // namespace suffuse
