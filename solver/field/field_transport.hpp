#pragma once

/// Fluidised fines as a field on the mesh (single-point formulation): the concentration is linear
/// in each element and carried by the volumes that cross faces.

#include "field/eulerian.hpp"
#include "field/solid_exchange.hpp"
#include "field/swept_steps.hpp"
#include "field/transport.hpp"

namespace suffuse {

/// A run of more explicit steps than this takes implicit ones (docs/accuracy.md).
inline constexpr double explicit_steps_of_a_run = 2000.0;

struct FieldTransportSettings {
  TransportScheme scheme = TransportScheme::by_count;
  double fines_from = 0.0;  ///< fines can be in the liquid after this time, s
  SweptSettings implicit;
  bool points_move = false;  ///< solid points change their places in the elements
};

template <int Dim>
class FieldTransport final : public Transport<Dim> {
 public:
  FieldTransport(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                 const std::vector<FaceCondition>& conditions,
                 const BoundaryValues<Dim>& boundary_values, const FieldTransportSettings& settings,
                 int threads);

  /// Without a limit where transport is implicit.
  [[nodiscard]] double longest_step(const std::vector<double>& face_rate) const override;
  [[nodiscard]] double longest_explicit_step(const std::vector<double>& face_rate) const override {
    return transport_safety * scheme_.steps_allowed(state_, face_rate);
  }
  /// Whether an interval with these volumes per second through faces is crossed by implicit steps.
  [[nodiscard]] bool is_implicit(const std::vector<double>& face_rate) const;
  [[nodiscard]] typename Transport<Dim>::Coupling coupling() const override {
    return {.steps = 32.0, .pore_growth = 2e-3};
  }
  /// Moves liquid and fines through an interval that the flow has crossed since `start`, s, while
  /// they exchange fines with the solid: in turns, in explicit steps, or together with it in one
  /// system, in implicit steps. Returns the volume of fines that crossed each face, m3. Throws
  /// NumericalError.
  [[nodiscard]] std::vector<double> move(double start, const FlowProgress& flow,
                                         SolidExchange<Dim>& exchange);

  void archive(StateArchive& archive) override { archive(state_, timing_, implicit_); }
  [[nodiscard]] std::vector<PassTiming> passes() const override;

  /// The liquid that is there when the run starts: without this air, m3 per element.
  void start(const std::vector<double>& air);
  /// Starts with the liquid as another run left it.
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
  /// Explicit steps that cross the interval. `gained`: volume that the liquid of each element
  /// gains, m3, in the interval; becomes that in each step.
  [[nodiscard]] std::vector<TransportStep> start_steps(double start, const FlowProgress& flow,
                                                       std::vector<double>& gained);
  /// Fines that each solid point gives to the liquid or takes from it, m3, at one moment between
  /// steps; empty: none.
  void receive(const std::vector<double>& exchange);
  /// Exchange at solid points as a field, m3 per element and field node. Its sum is that of the
  /// points exactly.
  void spread(const std::vector<double>& exchange, ElementField<Dim>& field) const;
  /// Again where the points have moved.
  void find_basis();

  const Grid<Dim>& grid_;
  const SoilMap<Dim>& soils_;
  FieldTransportSettings settings_;
  int threads_;
  ElementSides<Dim> sides_;
  EulerianTransport<Dim> scheme_;
  SweptSteps<Dim> implicit_;
  FinesState<Dim> state_;
  /// Values of the element's basis functions at its points; only of the first element's points
  /// where they lie alike in every element that has any.
  std::vector<ElementValues<Dim>> basis_;
  bool points_lie_alike_ = true;
  PassTiming timing_{"transport", 0, 0.0};

  // Kept, so that steps allocate nothing.
  TransportScratch<Dim> scratch_;
  ElementField<Dim> eroded_;
};

}  // namespace suffuse
