#pragma once

/// The explicit flow of a scene (`scheme = "explicit"`): the nodal scheme with its step, which is
/// checked against the stability limit during the run.

#include <vector>

#include "explicit/explicit_nodal.hpp"
#include "explicit/stability_limit.hpp"
#include "flow/flow_solver.hpp"

namespace suffuse {

/// Carries the flow from one of its steps to the next (material-point integration).
template <int Dim>
class FlowCarrier {
 public:
  virtual ~FlowCarrier() = default;
  /// Sets the porosity for the next steps, per element.
  virtual void before_steps(const std::vector<double>& porosity) = 0;
  /// Sets the state that a step starts from.
  virtual void before_step() = 0;
  /// Takes the change of a step of `dt` seconds.
  virtual void after_step(double dt) = 0;
};

template <int Dim>
class ExplicitFlow final : public FlowSolver<Dim> {
 public:
  ExplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid, const Skeleton<Dim>& solid,
               const FlowOptions& options);

  [[nodiscard]] ExplicitNodal<Dim>& scheme() { return scheme_; }
  /// Fluxes of the last step: at each node, m/s, and through a face along its normal, m3/s.
  void node_flux(VectorField<Dim>& flux) const;
  [[nodiscard]] double flux_through(int face) const {
    return operator_.face_flux(face, scheme_.velocity());
  }

  void update(double time, const PoreState& pores,
              const std::vector<double>& face_concentration) override;
  void start() override;
  void start_from(const EarlierFlow<Dim>& earlier) override;
  [[nodiscard]] typename FlowSolver<Dim>::CouplingLimits coupling_limits() const override {
    return {.one_transport_step = true, .follows_pores = false};
  }

  /// Lets the carrier, which must outlive the last step, take part in each step.
  void set_carrier(FlowCarrier<Dim>& carrier) { carrier_ = &carrier; }
  FlowStep<Dim> solve(const FlowInterval<Dim>& interval) override;
  FlowProgress commit(FlowStep<Dim> steps) override;

  [[nodiscard]] const std::vector<double>& pressure() const override { return scheme_.pressure(); }
  void match_masses(double time, const std::vector<double>& water_mass) override;

  void archive(StateArchive& archive) override;

  [[nodiscard]] FlowState<Dim> state(double time) const override;
  [[nodiscard]] std::vector<PassTiming> passes() const override { return {timing_}; }

  /// Stability limit with the present coefficients and speeds, with no element on a rank that does
  /// not have the worst one: that by elements, or in double-point scenes, if `step` exceeds it,
  /// that of the assembled scheme.
  [[nodiscard]] StabilityLimit current_limit(double step) const;

 private:
  /// Takes one step under the boundary values of its time.
  void step(double start, double dt);
  /// Takes all steps with the carrier.
  void take_carried_steps(const FlowStep<Dim>& steps);
  /// Shortens the step if the stability limit falls below it; throws NumericalError if the scene
  /// gave the step.
  void check_step(double time);
  void warn_of_locking(const VectorField<Dim>& steady_velocity);

  NodalOperator<Dim> operator_;
  ExplicitNodal<Dim> scheme_;
  double step_;
  bool step_given_;
  FlowCarrier<Dim>* carrier_ = nullptr;  ///< null if the flow itself keeps its state
  long last_steps_ = 1;                  ///< number of steps in the last interval
  double last_dt_ = 0.0;                 ///< their length, s
  PassTiming timing_{"flow", 0, 0.0};
  /// Both limits when the assembled one was last found; it is found again when the other has
  /// changed.
  mutable double assembled_limit_ = unset;
  mutable double element_limit_ = unset;
};

}  // namespace suffuse
