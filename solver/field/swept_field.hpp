#pragma once

/// Fluidised fines of the single-point formulation without a limit of the step: the concentration
/// is linear in each element, as in `EulerianTransport`, and found at the end of a step, element by
/// element along the flow. One sweep solves for it, and for what solid and liquid exchange.

#include <vector>

#include "field/element_balance.hpp"
#include "field/eulerian.hpp"
#include "field/sweep_order.hpp"

namespace suffuse {

template <int Dim>
class SweptField {
 public:
  SweptField(const Grid<Dim>& grid, const ElementSides<Dim>& sides, const SoilMap<Dim>& soils,
             const BoundaryValues<Dim>& boundary_values, int threads);

  /// Starts an interval in which `face_volume` m3 of liquid cross each face and elements gain
  /// `gained` m3 of liquid by the flow (empty: none).
  void start(const std::vector<double>& face_volume, std::vector<double> gained);
  /// Solves for a step: the share `share` of the interval. Changes no state. `errors`: what is not
  /// known of it. False where a circle of the flow finds no end: a shorter step may.
  [[nodiscard]] bool solve(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                           double share, StepErrors& errors);
  /// What solid points exchange in the step that was solved last, per volume of soil.
  [[nodiscard]] const std::vector<Exchange>& exchange() const { return exchange_; }
  /// Takes that step. `received`: what the solid gave, m3 per element and field node. Throws
  /// NumericalError where an element's mean concentration leaves [0, 1).
  void finish(FinesState<Dim>& state, const ElementField<Dim>& received);
  /// Volume of fines that crossed each face since `start`, m3.
  void fines_crossed(std::vector<double>& result) const;

  [[nodiscard]] const SweepOrder& order() const { return order_; }

 private:
  /// Sets what enters at a time, s, among concentrations at vertices.
  void set_entering(double time, std::vector<double>& at_vertices);
  StepErrors solve_element(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                           double share, int element, double& slope);
  [[nodiscard]] bool solve_circle(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                                  double share, const SweepOrder::Circle& circle,
                                  StepErrors& errors);

  const Grid<Dim>& grid_;
  const ElementSides<Dim>& sides_;
  const SoilMap<Dim>& soils_;
  const BoundaryValues<Dim>& boundary_values_;
  std::vector<FaceCondition> conditions_;  ///< of which only the concentrations are kept up
  int threads_;
  ElementBalance<Dim> balance_;

  ElementField<Dim> outflow_;  ///< of the interval, m3
  std::vector<UpwindPlaces<Dim>> upwind_;
  std::vector<double> gained_;
  std::vector<double> inflow_;  ///< of liquid, through each outer face, of the interval, m3
  SweepOrder order_;
  double share_ = 0.0;  ///< of the interval, of the step that was solved last
  /// Concentrations at the first stage and at the end, as ElementSides places them.
  std::vector<double> first_;
  std::vector<double> last_;
  std::vector<Exchange> exchange_;
  ElementField<Dim> fines_out_;  ///< through the sides of each element since `start`, m3
};

}  // namespace suffuse
