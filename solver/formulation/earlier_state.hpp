#pragma once

/// The last state of a run, from which another run starts on the same mesh and points.

#include "field/eulerian.hpp"
#include "flow/flow_solver.hpp"
#include "points/point_transport.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
struct EarlierState {
  SolidState solid = {};
  EarlierFlow<Dim> flow = {};

  // Single-point.
  FinesState<Dim> fines = {};
  std::vector<double> water_mass = {};  ///< per element, kg

  // Double-point.
  EarlierLiquid<Dim> liquid = {};
};

}  // namespace suffuse
