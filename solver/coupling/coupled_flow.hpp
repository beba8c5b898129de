#pragma once

/// A step of the flow and of a solid that may move: found together, then committed together. Solid
/// without an equilibrium fails (`Failure`). If the solid does not move, the step is that of the
/// flow.

#include <memory>

#include "coupling/failure.hpp"
#include "coupling/flow_and_motion.hpp"
#include "coupling/moved_air.hpp"
#include "flow/implicit_flow.hpp"

namespace suffuse {

/// How soil that moves gets its stress at the start: it finds it, has that of an earlier run, or
/// gets it later.
enum class SoilStart { finds_stress, has_stress, stress_later };

/// Flow and motion of a solid that moves, which needs the implicit flow.
template <int Dim>
class FlowOfMovingSolid {
 public:
  /// Keeps references.
  FlowOfMovingSolid(const Scene& scene, const Grid<Dim>& grid, ImplicitFlow<Dim>& flow,
                    MovingSkeleton<Dim>& solid, int threads);

  /// Finds the initial stress of the solid, if it has none, and the first step. Call after the flow
  /// has started.
  void start(SoilStart how);
  CoupledStep<Dim> solve(const FlowInterval<Dim>& interval);
  FlowProgress commit(CoupledStep<Dim> step);

  [[nodiscard]] const Failure<Dim>& failure() const { return failure_; }
  /// Iterations between flow and motion since the start.
  [[nodiscard]] long iterations() const { return iterations_; }
  void archive(auto& archive) { archive(failure_, rise_, iterations_, warned_of_gap_); }

 private:
  /// Adds a warning, once, where soil has moved farther from the boundary of the mesh than an
  /// element can hold. `pores` at the start of a step, s.
  void check_gaps(const ElementPores& pores, double start);

  const Grid<Dim>& grid_;
  ImplicitFlow<Dim>& flow_;
  MovingSkeleton<Dim>& solid_;
  FlowAndMotion<Dim> both_;
  Failure<Dim> failure_;
  PressureRise rise_;  ///< in the last step
  double end_;         ///< of the run, s
  double tolerance_;   ///< for the relative local error of a step
  long iterations_ = 0;
  bool warned_of_gap_ = false;
};

template <int Dim>
class CoupledFlow {
 public:
  /// Keeps references. `moving`: the solid, if it moves; otherwise null. A solid that moves needs
  /// the implicit flow.
  CoupledFlow(const Scene& scene, const Grid<Dim>& grid, FlowSolver<Dim>& flow,
              MovingSkeleton<Dim>* moving, int threads);

  /// Sets the state at the start of the run, or the last one of another run. The coefficients of
  /// the flow must be known.
  void start(SoilStart how);
  void start_from(const EarlierFlow<Dim>& earlier, SoilStart how);

  /// Finds a step within the interval. Flow and solid do not change, except soil that fails: it
  /// gets inertia here, and the step is found with it. Throws NumericalError; EquilibriumLost if
  /// soil fails and the scene does not follow it.
  CoupledStep<Dim> solve(const FlowInterval<Dim>& interval);
  /// Sets flow and solid to what the step has found.
  FlowProgress commit(CoupledStep<Dim> step);

  /// Iterations between flow and motion since the start; 0 if the solid does not move.
  [[nodiscard]] long iterations() const;
  /// Calls and seconds of each pass, for run.json.
  [[nodiscard]] std::vector<PassTiming> passes() const;
  /// Adds the time of the last failure to a row.
  void describe(HistoryRow& row) const;
  void archive(StateArchive& archive);

 private:
  FlowSolver<Dim>& flow_;
  std::unique_ptr<FlowOfMovingSolid<Dim>> moving_;  ///< null if the solid does not move
};

}  // namespace suffuse
