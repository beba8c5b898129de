#pragma once

/// How far the discharge of a steady flow can be off (docs/theory/flow.md, "Bounds of the
/// discharge").
///
/// The fluxes q of the mixed elements balance in every element; a continuous head h has the
/// prescribed values. The gap between -K^-1 q and grad h in the energy norm is the square sum of
/// both errors (Prager and Synge, Q. Appl. Math. 5 (1947) 241). With the gap of the dual problem, a
/// unit head at one boundary, the discharge there is known to half the product of the two gaps.

#include <optional>
#include <string>
#include <vector>

#include "bounds/interval.hpp"
#include "bounds/seepage_state.hpp"

namespace suffuse {

/// Means over a disc (in three dimensions a ball) around a probe of the scene, or over its part in
/// the soil that the probe lies in, and how far they can be off on this mesh.
struct ProbeMeans {
  double radius = 0.0;  ///< m
  Interval head;        ///< m
  StepEstimates head_step;
  /// Slope of the head in the direction of its mean slope, 1.
  Interval gradient;
  StepEstimates gradient_step;
};

struct DischargeBounds {
  /// Why the intervals are estimates; empty where they are bounds.
  std::string why_estimates;
  /// Per entry of the scene's boundaries: liquid that leaves minus liquid that enters, m3/s. None
  /// where the boundary shares a node with another one that holds a head.
  std::vector<std::optional<Interval>> boundaries;
  std::vector<StepEstimates> boundary_steps;  ///< of the same, m3/s
  /// Sum over the boundaries through which more leaves than enters, m3/s. There is none in two
  /// cases. Liquid enters and leaves by one boundary: then `flux_out` of the history is larger than
  /// this sum. Or elements store water and the sum follows from that alone: its errors are unknown.
  std::optional<Interval> flux_out;
  StepEstimates flux_out_step;  ///< errors of the last step in it, m3/s
  /// What leaves through boundaries that hold heads, m3/s. If a well balances the discharge: that
  /// of the boundary with a head whose discharge is known least accurately. None if nothing flows
  /// from one head to another.
  std::optional<Interval> least_known;
  /// The largest conductivity times the largest head, or the size of the model if that is larger,
  /// and the size of the model: no discharge is larger by orders of magnitude, m3/s.
  double largest_flux = 0.0;
  /// Each element's part in the half-width of `least_known`, m3/s; zero where there is none.
  std::vector<double> error;
  /// Estimates, per probe of the scene; none where no head determines the heads there.
  std::vector<std::optional<ProbeMeans>> probes;
};

/// Intervals of the discharge. They are bounds for steady saturated flow by Darcy's law whose heads
/// are continuous along the boundary; seepage faces are taken as they are now. Costs a steady
/// solution for each boundary with a head beyond the second, and two for each probe. Throws
/// NumericalError.
template <int Dim>
DischargeBounds discharge_bounds(const SeepageState<Dim>& state);

}  // namespace suffuse
