#pragma once

/// Fluidised fines as a field on the mesh (single-point formulation): the concentration is linear
/// in each element and carried by the volumes that cross faces.

#include "field/eulerian.hpp"
#include "field/solid_exchange.hpp"
#include "field/swept_steps.hpp"
#include "field/transport.hpp"

namespace suffuse {

/// A run that would need more explicit steps takes implicit ones (docs/evidence/accuracy.md).
inline constexpr double explicit_steps_of_a_run = 2000.0;

struct FieldTransportSettings {
  TransportScheme scheme = TransportScheme::by_count;
  double fines_from = 0.0;  ///< fines can be in the liquid after this time, s
  SweptSettings implicit;
  bool points_move = false;  ///< solid points move within elements
};

template <int Dim>
class FieldTransport final : public Transport<Dim> {
 public:
  FieldTransport(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                 const std::vector<FaceCondition>& conditions,
                 const BoundaryValues<Dim>& boundary_values, const FieldTransportSettings& settings,
                 int threads);

  /// Infinite for implicit transport.
  [[nodiscard]] double longest_step(const std::vector<double>& face_rate) const override;
  [[nodiscard]] double longest_explicit_step(const std::vector<double>& face_rate) const override {
    return transport_safety * scheme_.steps_allowed(state_, face_rate);
  }
  /// Whether transport is implicit at these volumes per second through faces.
  [[nodiscard]] bool is_implicit(const std::vector<double>& face_rate) const;
  [[nodiscard]] typename Transport<Dim>::Coupling coupling() const override {
    return {.steps = 32.0, .pore_growth = 2e-3};
  }
  /// Moves liquid and fines through the interval of the flow from `start`, s, and exchanges fines
  /// with the solid: alternately in explicit steps, or in one system in implicit steps. Returns the
  /// volume of fines that crossed each face, m3. Throws NumericalError.
  [[nodiscard]] std::vector<double> move(double start, const FlowProgress& flow,
                                         SolidExchange<Dim>& exchange);

  void archive(StateArchive& archive) override { archive(state_, timing_, implicit_); }
  [[nodiscard]] std::vector<PassTiming> passes() const override;

  /// Removes the air at the start of the run, m3 per element, from the liquid.
  void start(const std::vector<double>& air);
  /// Starts from the last liquid of another run.
  void start_from(const FinesState<Dim>& earlier) { state_ = earlier; }
  [[nodiscard]] const FinesState<Dim>& state() const { return state_; }
  /// Mean concentration of the liquid that would cross each face at these volumes.
  [[nodiscard]] std::vector<double> face_concentration(double time,
                                                       const std::vector<double>& face_rate) const;

 private:
  [[nodiscard]] bool holds_fines(double time) const { return time > settings_.fines_from; }
  [[nodiscard]] std::vector<double> move_explicitly(double start, const FlowProgress& flow,
                                                    SolidExchange<Dim>& exchange);
  [[nodiscard]] std::vector<double> move_implicitly(double start, const FlowProgress& flow,
                                                    SolidExchange<Dim>& exchange);
  /// Explicit steps over the interval. `gained`: volume of liquid that each element gains in the
  /// interval, m3; becomes that of each step.
  [[nodiscard]] std::vector<TransportStep> start_steps(double start, const FlowProgress& flow,
                                                       std::vector<double>& gained);
  /// Adds the exchange of each solid point, m3, to the liquid between two steps; empty: none.
  void receive(const std::vector<double>& exchange);
  /// Distributes the exchange of solid points to field nodes, m3 per element and node. The sum
  /// stays the same.
  void spread(const std::vector<double>& exchange, ElementField<Dim>& field) const;
  /// Finds `basis_`. To be repeated when points have moved.
  void find_basis();

  const Grid<Dim>& grid_;
  const SoilMap<Dim>& soils_;
  FieldTransportSettings settings_;
  int threads_;
  ElementSides<Dim> sides_;
  EulerianTransport<Dim> scheme_;
  SweptSteps<Dim> implicit_;
  FinesState<Dim> state_;
  /// Values of the element's basis functions at its points. If points have the same barycentric
  /// places in all elements with points, only those of one element.
  std::vector<ElementValues<Dim>> basis_;
  bool points_lie_alike_ = true;
  PassTiming timing_{"transport", 0, 0.0};

  // Kept to avoid allocations in steps.
  TransportScratch<Dim> scratch_;
  ElementField<Dim> eroded_;
};

}  // namespace suffuse
