#pragma once

/// A step of the flow: what it is to follow, what was found for it, and what came of it.

#include <optional>
#include <string>
#include <vector>

#include "mixed/implicit_mixed.hpp"
#include "solid/pores.hpp"

namespace suffuse {

/// A coupling interval: the flow advances through it alone, then erosion and transport follow.
template <int Dim>
struct FlowInterval {
  double start = 0.0;              ///< s
  double latest = 0.0;             ///< latest end: the next output or the end of the run, s
  double longest = 0.0;            ///< longest duration that erosion and transport can follow, s
  const PoreForecast<Dim>& pores;  ///< the pores within the interval, as erosion opens them
};

/// Steps of the flow that it has solved for and not taken yet. An implicit step has its result
/// here. Explicit steps are as many as the interval allows, and are taken one after the other as
/// they are committed: there is nothing to solve.
template <int Dim>
struct FlowStep {
  double start = 0.0;  ///< s
  double dt = 0.0;     ///< of each, s
  double until = 0.0;  ///< end of explicit steps, latest end of an implicit one, s
  long count = 1;

  // An implicit step.

  std::vector<FlowForcing<Dim>> forcing = {};  ///< per stage
  MixedStep<Dim> found = {};
  std::vector<double> reservoir_rates = {};  ///< at which levels rise in the step, m/s
  bool is_kept = false;                      ///< the flow is steady and was not solved again
  /// At the end of the step, as erosion will have made them; none where the flow does not follow.
  std::optional<FlowCoefficients<Dim>> expected = {};
  // Where a solid moves in the step: see FlowProgress.
  std::vector<double> room_gained = {};
  std::vector<double> relative = {};

  // Explicit steps.

  std::vector<double> porosity = {};  ///< per element, where points carry the flow

  [[nodiscard]] double start_of(long step) const { return start + static_cast<double>(step) * dt; }
};

/// Why a step has no solution. A shorter one may have.
struct Unsolved {
  std::string text;
  bool no_equilibrium = false;  ///< of the solid
  int worst_node = -1;          ///< at which its forces are out of balance most; -1: not known
};

/// What the flow did in a coupling interval.
struct FlowProgress {
  long steps = 0;       ///< that it took
  double dt = 0.0;      ///< length of the last one, s
  double end = 0.0;     ///< of the interval, s: its latest end, or before where the flow chose so
  FaceVolumes volumes;  ///< that crossed the faces since its start
  /// Per element: volume that liquid has gained in the pores, m3: air that it has displaced, solid
  /// that has moved out. Empty where there is neither.
  std::vector<double> room_gained = {};
  /// The liquid that crossed faces relative to the solid, m3; empty where the solid stays in place:
  /// then `volumes` are that.
  std::vector<double> relative = {};

  [[nodiscard]] const std::vector<double>& relative_volumes() const {
    return relative.empty() ? volumes.liquid : relative;
  }
};

}  // namespace suffuse
