#pragma once

/// The explicit flow of a scene (`scheme = "explicit"`): the nodal scheme with its step, checked
/// against the stability limit as the run goes.

#include <vector>

#include "flow/explicit_nodal.hpp"
#include "flow/flow_solver.hpp"
#include "flow/stability_limit.hpp"

namespace suffuse {

/// Whoever carries velocity and pressure from one step of the flow to the next, in place of nodes
/// and elements (material-point integration).
class FlowCarrier {
 public:
  FlowCarrier() = default;
  virtual ~FlowCarrier() = default;
  FlowCarrier(const FlowCarrier&) = delete;
  FlowCarrier& operator=(const FlowCarrier&) = delete;

  /// Steps are about to begin that take `duration` seconds together.
  virtual void start(double duration) = 0;
  /// Before a step of `dt` that begins at `time`: hands velocity and pressure over to the scheme.
  virtual void give(double time, double dt) = 0;
  /// After it, when those who look have looked: takes back what it changed, and moves.
  virtual void take() = 0;
};

template <int Dim>
class ExplicitFlow final : public FlowSolver<Dim> {
 public:
  ExplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
               const FlowOptions& options);

  [[nodiscard]] ExplicitNodal<Dim>& scheme() { return scheme_; }
  /// From now on the flow is carried by this one, which outlives it.
  void set_carrier(FlowCarrier& carrier) { carrier_ = &carrier; }
  /// Fluxes of the last step: of each node, m/s, and through a face along its normal, m3/s.
  void node_flux(VectorField<Dim>& flux) const;
  [[nodiscard]] double flux_through(int face) const {
    return operator_.face_flux(face, scheme_.velocity());
  }

  void update(double time, const PoreState& content,
              const std::vector<double>& face_concentration) override;
  void start() override;
  /// Steps of one length, as many as the interval allows. Shortens the step when the stability
  /// limit falls below it, or throws NumericalError when the scene gave it.
  FlowProgress<Dim> run(const FlowInterval<Dim>& interval) override;

  [[nodiscard]] const std::vector<double>& pressure() const override { return scheme_.pressure(); }
  void follow_masses(double time, const std::vector<double>& water_mass) override;

  void archive(StateArchive& archive) override;

  [[nodiscard]] FlowState<Dim> moment(double time) const override;
  [[nodiscard]] std::vector<PassTiming> passes() const override { return {timing_}; }

  /// Stability limit with the coefficients and speeds of this moment: element by element, and in
  /// double-point scenes, where `step` is above that, of the assembled scheme.
  [[nodiscard]] StabilityLimit current_limit(double step) const;

 private:
  void check_step(double time);
  /// One step of the scheme under the boundary values of its time.
  void step(double begin, double dt);
  /// What follows a step where the flow has a carrier.
  void carry(double begin, double dt);
  [[nodiscard]] FlowState<Dim> moment_of(double time, std::vector<double> pressure,
                                         VectorField<Dim> velocity) const;
  [[nodiscard]] Passed<Dim> passed() const;
  void warn_of_locking(const VectorField<Dim>& steady_velocity);

  NodalOperator<Dim> operator_;
  ExplicitNodal<Dim> scheme_;
  double step_;
  bool step_given_;
  FlowCarrier* carrier_ = nullptr;
  PassTiming timing_{"flow", 0, 0.0};
  /// The two limits when the assembled one was last found; it follows the other until that has
  /// moved.
  mutable double assembled_limit_ = unset;
  mutable double element_limit_ = unset;
};

}  // namespace suffuse
