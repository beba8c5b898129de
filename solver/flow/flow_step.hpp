#pragma once

/// A step of the flow: its interval, its solution, and its result.

#include <optional>
#include <string>
#include <vector>

#include "mixed/implicit_mixed.hpp"
#include "solid/pores.hpp"

namespace suffuse {

/// A coupling interval: first the flow advances through it, then erosion and transport follow.
template <int Dim>
struct FlowInterval {
  double start = 0.0;              ///< s
  double latest = 0.0;             ///< latest end: the next output or the end of the run, s
  double longest = 0.0;            ///< longest duration that erosion and transport can follow, s
  const PoreForecast<Dim>& pores;  ///< the pores within the interval, as erosion changes them
};

/// Steps of the flow that are not committed yet. An implicit step has its solution here. Explicit
/// steps, as many as the interval allows, need no solution: `commit` takes them one after the
/// other.
template <int Dim>
struct FlowStep {
  double start = 0.0;  ///< s
  double dt = 0.0;     ///< of each, s
  double until = 0.0;  ///< end of explicit steps, latest end of an implicit one, s
  long count = 1;

  // An implicit step.

  std::vector<FlowForcing<Dim>> forcing = {};  ///< per stage
  MixedStep<Dim> found = {};
  std::vector<double> reservoir_rates = {};  ///< see `BoundaryValues::stage_rates`
  bool is_kept = false;                      ///< the flow is steady and was not solved again
  /// Pores at the end of the step, from erosion alone; none if the flow does not follow pores.
  std::optional<PoreState> expected = {};
  // If a solid moves in the step: see FlowProgress.
  std::vector<double> room_gained = {};
  std::vector<double> relative = {};

  // Explicit steps.

  std::vector<double> porosity = {};  ///< per element, where points carry the flow

  [[nodiscard]] double start_of(long step) const { return start + static_cast<double>(step) * dt; }
};

/// Why a step has no solution. A shorter one may have one.
struct Unsolved {
  std::string text;
  bool no_equilibrium = false;  ///< the forces of the solid do not balance
  int worst_node = -1;          ///< node with the largest residual of its forces; -1: not known
};

/// What the flow did in a coupling interval.
struct FlowProgress {
  long steps = 0;       ///< number of steps taken
  double dt = 0.0;      ///< length of the last one, s
  double end = 0.0;     ///< of the interval, s: its latest end, or earlier by choice of the flow
  FaceVolumes volumes;  ///< that crossed the faces since the start of the interval
  /// Per element: volume that liquid has gained in the pores, m3, by displaced air and by solid
  /// that left. Empty if there is neither.
  std::vector<double> room_gained = {};
  /// Liquid that crossed faces relative to the solid, m3; empty if the solid does not move, as
  /// `volumes` are relative to it then.
  std::vector<double> relative = {};

  [[nodiscard]] const std::vector<double>& relative_volumes() const {
    return relative.empty() ? volumes.liquid : relative;
  }
};

}  // namespace suffuse
