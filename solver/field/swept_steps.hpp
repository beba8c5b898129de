#pragma once

/// The steps of implicit transport through an interval of the flow: each is tried, judged by its
/// error, and accepted or shortened.

#include <limits>

#include "field/swept_field.hpp"
#include "field/transport.hpp"
#include "results/pass_timer.hpp"

namespace suffuse {

struct SweptSettings {
  double end = 0.0;            ///< of the run, s
  double tolerance = 1e-3;     ///< bound of a step's error, relative
  bool step_is_given = false;  ///< an interval is one step, for any error
};

template <int Dim>
class SweptSteps {
 public:
  SweptSteps(const Grid<Dim>& grid, const ElementSides<Dim>& sides, const SoilMap<Dim>& soils,
             const BoundaryValues<Dim>& boundary_values, const SweptSettings& settings, int threads)
      : field_(grid, sides, soils, boundary_values, threads),
        settings_(settings),
        round_off_(4.0 * std::numeric_limits<double>::epsilon() * volume_of(grid)) {}

  /// Starts an interval of the flow.
  void start(double start, const FlowProgress& flow);
  [[nodiscard]] bool finished() const { return time_ >= end_; }
  /// Solves the next step. Returns the exchange of the solid points in it, per volume of soil.
  /// Throws NumericalError if no step is short enough.
  const std::vector<Exchange>& solve(const FinesState<Dim>& state, const Skeleton<Dim>& solid,
                                     const PointFlows& flows);
  /// Applies the solved step. `received`: fines from the solid, m3 per element and field node.
  void finish(FinesState<Dim>& state, const ElementField<Dim>& received);

  [[nodiscard]] const SweptField<Dim>& field() const { return field_; }
  [[nodiscard]] const PassTiming& timing() const { return timing_; }
  void archive(auto& archive) { archive(next_, most_held_, exchanged_, timing_); }

 private:
  [[nodiscard]] static double volume_of(const Grid<Dim>& grid) {
    double own = 0.0;
    for (const int e : grid.own_elements()) own += grid.volume[e];
    return sum_of_all(grid.ranks(), own);
  }
  /// Error of a step of `dt` over the tolerance. The error of fines in elements is relative to the
  /// most fines that the liquid has held, that of the exchange to the total exchange. Their
  /// smallest reference is the gain of fines at the present rate in a millionth of the run.
  [[nodiscard]] double relative(const StepErrors& errors, double dt) const;

  SweptField<Dim> field_;
  SweptSettings settings_;
  double round_off_;    ///< of the eroded volume, a difference of solid volumes, m3
  double start_ = 0.0;  ///< of the interval, s
  double end_ = 0.0;
  double time_ = 0.0;                                      ///< reached in the interval, s
  double dt_ = 0.0;                                        ///< of the last solved step, s
  StepErrors errors_;                                      ///< of the last solved step
  double next_ = std::numeric_limits<double>::infinity();  ///< length of the next step, s
  double most_held_ = 0.0;                                 ///< most fines in the liquid, m3
  double exchanged_ = 0.0;  ///< absolute exchange of solid and liquid, m3
  PassTiming timing_{"transport, implicit", 0, 0.0};
};

}  // namespace suffuse
