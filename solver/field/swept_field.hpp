#pragma once

/// Implicit transport of fluidised fines in the single-point formulation, without a limit of the
/// step. The concentration is linear in each element, as in `EulerianTransport`. One sweep along
/// the flow solves for it and for the exchange with the solid, element by element.

#include <vector>

#include "field/element_balance.hpp"
#include "field/eulerian.hpp"
#include "grid/sweep_order.hpp"

namespace suffuse {

template <int Dim>
class SweptField {
 public:
  SweptField(const Grid<Dim>& grid, const ElementSides<Dim>& sides, const SoilMap<Dim>& soils,
             const BoundaryValues<Dim>& boundary_values, int threads);

  /// Starts an interval in which `face_volume` m3 of liquid cross each face and elements gain
  /// `gained` m3 of liquid by the flow (empty: none).
  void start(const std::vector<double>& face_volume, std::vector<double> gained);
  /// Solves a step, the share `share` of the interval, without changing the state; estimates its
  /// `errors`. False if the iteration over a circle does not converge; a shorter step may.
  [[nodiscard]] bool solve(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                           double share, StepErrors& errors);
  /// Exchange of the solid points in the last solved step, per volume of soil.
  [[nodiscard]] const std::vector<Exchange>& exchange() const { return exchange_; }
  /// Applies the solved step. `received`: fines from the solid, m3 per element and field node.
  /// Throws NumericalError if an element's mean concentration leaves [0, 1).
  void finish(FinesState<Dim>& state, const ElementField<Dim>& received);
  /// Volume of fines that crossed each face since `start`, m3.
  void fines_crossed(std::vector<double>& result) const;

  [[nodiscard]] const SweepOrder& order() const { return order_; }

 private:
  void find_order();
  /// Sets the concentrations that enter at a time, s, in `at_vertices`.
  void set_entering(double time, std::vector<double>& at_vertices);
  StepErrors solve_element(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                           double share, int element, double& slope);
  [[nodiscard]] bool solve_circle(const FinesState<Dim>& state, const SolidInStep<Dim>& solid,
                                  double share, const SweepOrder::Part& circle,
                                  StepErrorSums& errors);
  /// Makes the values of other ranks' elements known here.
  void send_values() {
    grid_.element_rows().template exchange_blocks<Dim + 1>(first_);
    grid_.element_rows().template exchange_blocks<Dim + 1>(last_);
  }

  const Grid<Dim>& grid_;
  const ElementSides<Dim>& sides_;
  const SoilMap<Dim>& soils_;
  const BoundaryValues<Dim>& boundary_values_;
  std::vector<FaceCondition> conditions_;  ///< only their concentrations are updated
  int threads_;
  ElementBalance<Dim> balance_;
  Ranks alone_;     ///< for circles of one rank
  OwnRows points_;  ///< the solid points

  ElementField<Dim> outflow_;  ///< of the interval, m3
  std::vector<UpwindPlaces<Dim>> upwind_;
  std::vector<double> gained_;
  std::vector<double> inflow_;  ///< liquid through each own outer face in the interval, m3
  SweepOrder order_;
  double share_ = 0.0;  ///< of the last solved step in the interval
  /// Concentrations at the first stage and at the end, in the order of ElementSides.
  std::vector<double> first_;
  std::vector<double> last_;
  std::vector<Exchange> exchange_;
  ElementField<Dim> fines_out_;  ///< through the sides of each element since `start`, m3
};

}  // namespace suffuse
