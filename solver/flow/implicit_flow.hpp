#pragma once

/// The implicit flow of a scene (`scheme = "implicit"`): mixed finite elements, with steps chosen
/// by the scene's tolerance or given by it. A step is tried, judged by its error, and accepted or
/// shortened; a flow that has become steady is reused and not solved again. The parts that decide
/// are classes of their own.

#include <optional>
#include <vector>

#include "coupling/solid_coupling.hpp"
#include "flow/coefficient_blending.hpp"
#include "flow/flow_scales.hpp"
#include "flow/flow_solver.hpp"
#include "flow/mass_relaxation.hpp"
#include "flow/steady_reuse.hpp"
#include "flow/step_control.hpp"
#include "mixed/implicit_mixed.hpp"
#include "mixed/mixed_flow.hpp"

namespace suffuse {

template <int Dim>
class ImplicitFlow final : public FlowSolver<Dim> {
 public:
  ImplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid, Skeleton<Dim>& solid,
               const FlowOptions& options);

  void update(double time, const PoreState& pores,
              const std::vector<double>& face_concentration) override;
  void start() override;
  void start_from(const EarlierFlow<Dim>& earlier) override;
  /// One step. Throws NumericalError when no step is short enough for the tolerance.
  FlowProgress advance(const FlowInterval<Dim>& interval) override;
  [[nodiscard]] double step_within(double tolerance) const override {
    return control_.step_within(tolerance);
  }
  void plan_step(double dt) override { control_.plan(dt); }
  [[nodiscard]] typename FlowSolver<Dim>::CouplingLimits coupling_limits() const override {
    return {.one_transport_step = false, .follows_pores = true};
  }

  [[nodiscard]] const std::vector<double>& pressure() const override { return pressure_; }
  [[nodiscard]] std::vector<double> air() const override;
  [[nodiscard]] ElementField<Dim> air_at_sides() const override { return now_.state.air; }
  /// Where an element's water does not fit its pores at its pressure, the next steps let it out.
  void match_masses(double time, const std::vector<double>& water_mass) override;

  void archive(StateArchive& archive) override;

  [[nodiscard]] FlowState<Dim> state(double time) const override;
  [[nodiscard]] std::vector<double> face_flux(double /*time*/) const override {
    return now_.face_flux;
  }
  [[nodiscard]] long coupling_iterations() const override { return coupling_.iterations(); }
  [[nodiscard]] std::vector<PassTiming> passes() const override;

 private:
  /// Moves the solid as the step has found, and adds what it takes along to what has crossed faces.
  void move_solid(MixedStep<Dim>& step, FlowProgress& progress);
  /// The start from this flow, or from the steady one where water flows at once. `air`: none to
  /// take that of the pressures.
  void start_with(MixedFlow<Dim> flow, const ElementField<Dim>* air);
  /// Tries steps from the start of the interval, the first of `dt` seconds, until one is accurate
  /// enough; `dt` becomes its length.
  [[nodiscard]] MixedStep<Dim> accepted_step(const FlowInterval<Dim>& interval, double& dt);
  /// A step, or nothing and a shorter `dt` where its iteration does not converge.
  [[nodiscard]] std::optional<MixedStep<Dim>> try_step(
      const FlowInterval<Dim>& interval, double& dt,
      const std::vector<const FlowForcing<Dim>*>& stages);
  /// Water expands as it moves towards lower pressures. Where a step is so long that it would not
  /// fit its elements, solves it again with the sources that let it out.
  void let_out_expansion(double dt, const std::vector<const FlowForcing<Dim>*>& stages,
                         MixedStep<Dim>& step);
  /// Volume by which an element's water grows beyond what its pores take at its pressure, m3.
  [[nodiscard]] std::vector<double> expansion_in(const MixedStep<Dim>& step) const;
  /// Volume per element, m3, that a step of `dt` would have to let out in addition. Empty where the
  /// step is short or lets out enough.
  [[nodiscard]] std::vector<double> excess_in(const MixedStep<Dim>& step, double dt) const;
  void follow_soils() {
    if (solid_.moves()) {
      scheme_.follow(flow_soils(this->scene(), solid_.soils(), solid_.filling()));
    }
  }
  /// Coefficients, boundary values and sources at each stage of a step of `dt`.
  void find_forcing(const FlowInterval<Dim>& interval, double dt);
  /// Coefficients at a time within the interval, as erosion will have made them.
  [[nodiscard]] FlowCoefficients<Dim> coefficients_at(const FlowInterval<Dim>& interval,
                                                      double time) const;
  [[nodiscard]] double error_of(const MixedStep<Dim>& step, double start, double dt) const;
  /// The steady flow over `dt` seconds more, with the sources that let out what water expands by in
  /// that time. Nothing, and no more reuse, where these change the flow by too much.
  [[nodiscard]] std::optional<MixedStep<Dim>> steady_step(double dt);
  /// The flow of now for `dt` seconds.
  [[nodiscard]] MixedStep<Dim> kept_flow(double dt) const;
  void remember(MixedStep<Dim> step, double dt);
  /// A step of `dt` ended on a breakpoint at `time`: the flow may have a kink there.
  void pass_breakpoint(double time, double dt);
  /// From here on the flow is reused, if it has become steady and nothing that drives it will
  /// change by itself.
  void reuse_if_steady(double time);
  /// Throws NumericalError: this mass of water, kg, is not what the element's pores take.
  [[noreturn]] void refuse_misfit(std::size_t element, double time, double water_mass) const;
  /// Solves the steady flow again where its sources have changed.
  void update_steady_flow();
  /// Solves the steady flow with this source, m3/s per element. Where that changes the flow by too
  /// much, leaves the flow as it is, stops to reuse it, and returns false.
  bool take_steady_flow(std::vector<double> source);
  /// Takes the pressures and fluxes of a steady flow; the air stays where it is.
  void replace_flow(MixedStep<Dim> steady) {
    steady.end.air = std::move(now_.state.air);
    now_ = end_of(std::move(steady));
  }
  [[nodiscard]] std::vector<double> element_pressure_now() const {
    return element_pressure(this->grid(), now_.state.face_pressure, this->threads());
  }
  /// Time in which the largest flux fills the pores of the smallest element, s; infinite at rest.
  [[nodiscard]] double filling_time() const;
  /// A time that is short against everything that the flow does by itself, s: at the end of a step
  /// of this length the flow is the one right after the start. Infinite where nothing delays it.
  /// `soil_storage`: see `fastest_rate`.
  [[nodiscard]] double shortest_change(const std::vector<double>& soil_storage) const;
  /// Power that drag takes in each element, W, where the liquid's viscosity follows a front of
  /// fines: the resistance of an element that the front crosses counts by as much. Else empty.
  [[nodiscard]] std::vector<double> losses() const;

  FlowOptions options_;
  Skeleton<Dim>& solid_;
  ImplicitMixed<Dim> scheme_;
  SolidCoupling<Dim> coupling_;
  bool has_gravity_;
  bool follows_pores_;  ///< coefficients change with porosity within a step

  StepControl control_;
  CoefficientBlending<Dim> blending_;
  MassRelaxation relaxation_;
  SteadyReuse<Dim> reuse_;
  FlowScales scales_;

  std::vector<FlowForcing<Dim>> forcing_;  ///< per stage of the step that is tried
  MixedFlow<Dim> now_;
  /// At the start of the last step, for the prediction of the next; none after a kink.
  std::optional<MixedFlow<Dim>> previous_;
  std::vector<double> pressure_;  ///< per element, Pa
  double eos_error_ = 0.0;

  PassTiming solving_{"flow", 0, 0.0};
  PassTiming reusing_{"flow, steady and kept", 0, 0.0};
};

}  // namespace suffuse
