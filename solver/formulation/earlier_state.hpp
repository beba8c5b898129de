#pragma once

/// The last state of a run, from which another run starts on the same mesh.

#include <optional>

#include "field/eulerian.hpp"
#include "flow/flow_solver.hpp"
#include "motion/moved_soil.hpp"
#include "points/point_transport.hpp"

namespace suffuse {

template <int Dim>
struct EarlierState {
  SolidState solid = {};
  std::optional<MovedSoil<Dim>> moved = {};  ///< in the place of `solid`, if the skeleton moves
  EarlierFlow<Dim> flow = {};

  // Single-point.
  FinesState<Dim> fines = {};
  std::vector<double> water_mass = {};  ///< per element, kg

  // Double-point.
  EarlierLiquid<Dim> liquid = {};
};

}  // namespace suffuse
