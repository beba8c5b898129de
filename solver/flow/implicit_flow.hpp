#pragma once

/// The implicit flow of a scene (`scheme = "implicit"`): mixed finite elements, with steps chosen
/// by the scene's tolerance or given by it. A step is tried, judged by its error, and accepted or
/// shortened; a flow that has become steady is reused and not solved again. The parts that decide
/// are classes of their own.

#include <optional>
#include <vector>

#include "flow/coefficient_blending.hpp"
#include "flow/flow_scales.hpp"
#include "flow/flow_solver.hpp"
#include "flow/mass_relaxation.hpp"
#include "flow/steady_reuse.hpp"
#include "flow/step_control.hpp"
#include "mixed/implicit_mixed.hpp"
#include "mixed/mixed_flow.hpp"

namespace suffuse {

/// What the flow needs to know of a solid that moves, at the start.
struct MovingSolid {
  double load_change = 0.0;             ///< largest change of tractions in the run, Pa
  double stiffness = 0.0;               ///< largest modulus of soil that cannot move sideways, Pa
  std::vector<double> compressibility;  ///< per element, m3/Pa
  double time_of_fall = 0.0;  ///< of soil that does not stand, through an element, s; otherwise 0
};

template <int Dim>
class ImplicitFlow final : public FlowSolver<Dim> {
 public:
  ImplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid, const Skeleton<Dim>& solid,
               const FlowOptions& options);

  void update(double time, const PoreState& pores,
              const std::vector<double>& face_concentration) override;
  void start() override;
  void start_from(const EarlierFlow<Dim>& earlier) override;
  /// After `start` and its like: chooses the first step for a solid that moves too.
  void start_steps(const MovingSolid& solid);

  /// One step. Throws NumericalError when no step is short enough for the tolerance.
  FlowStep<Dim> solve(const FlowInterval<Dim>& interval) override;
  FlowProgress commit(FlowStep<Dim> step) override;

  // `solve` in pieces, for who solves for something else in the same step (coupling/).

  /// The step to try first, without forcing and result.
  [[nodiscard]] FlowStep<Dim> propose(const FlowInterval<Dim>& interval);
  /// Sets coefficients, boundary values and sources at each stage of the step.
  void set_forcing(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) const;
  /// Whether what was found for the step is accurate enough. Otherwise shortens it. Throws as
  /// `solve` does.
  [[nodiscard]] bool accepts(const FlowInterval<Dim>& interval, FlowStep<Dim>& step);
  /// The step has no solution: shortens it. Throws as `solve` does.
  void reject(FlowStep<Dim>& step) { control_.reject(step.start, step.dt); }
  /// The step is to be tried anew, as long as the last one was or longer: the solid has inertia
  /// now.
  void plan_anew(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) const;
  /// Whether a step that has no solution is too short to be tried shorter still.
  [[nodiscard]] bool is_shortest(const FlowStep<Dim>& step) const;

  [[nodiscard]] ImplicitMixed<Dim>& scheme() { return scheme_; }
  [[nodiscard]] const ImplicitMixed<Dim>& scheme() const { return scheme_; }
  /// Counts what `solve` takes.
  [[nodiscard]] PassTiming& timing() { return solving_; }
  [[nodiscard]] const MixedState<Dim>& mixed_state() const { return now_.state; }
  /// Length of the next step as it will be tried, s.
  [[nodiscard]] double next_step() const { return control_.next_step(); }
  [[nodiscard]] bool is_breakpoint(double time) const {
    return contains_time(this->breakpoints(), time);
  }

  [[nodiscard]] double step_within(double tolerance) const override {
    return control_.step_within(tolerance);
  }
  void plan_step(double dt) override { control_.plan(dt); }
  [[nodiscard]] typename FlowSolver<Dim>::CouplingLimits coupling_limits() const override {
    return {.one_transport_step = false, .follows_pores = true};
  }

  [[nodiscard]] const std::vector<double>& pressure() const override { return pressure_; }
  [[nodiscard]] std::vector<double> air() const override {
    return element_sums<Dim>(now_.state.air);
  }
  [[nodiscard]] ElementField<Dim> air_at_sides() const override { return now_.state.air; }
  /// Where an element's water does not fit its pores at its pressure, the next steps let it out.
  void match_masses(double time, const std::vector<double>& water_mass) override;

  void archive(StateArchive& archive) override;

  [[nodiscard]] FlowState<Dim> state(double time) const override;
  [[nodiscard]] std::vector<double> face_flux(double /*time*/) const override {
    return now_.face_flux;
  }
  [[nodiscard]] std::vector<PassTiming> passes() const override;

 private:
  /// The start from this flow, or from the steady one where water flows at once. `air`: none to
  /// take that of the pressures.
  void start_with(MixedFlow<Dim> flow, const ElementField<Dim>* air);
  /// Solves for a step of this length, with levels of reservoirs that fit what seeps. Says why
  /// where it has no solution.
  [[nodiscard]] std::optional<Unsolved> try_step(const FlowInterval<Dim>& interval,
                                                 FlowStep<Dim>& step);
  /// How fast levels of reservoirs rise by what seeps in the step, m/s.
  [[nodiscard]] std::vector<double> rates_of_reservoirs(const FlowStep<Dim>& step) const {
    return this->boundary_values().reservoir_rates(step.found.face_volume, step.dt);
  }
  [[nodiscard]] MixedStep<Dim> solved(const FlowStep<Dim>& step);
  /// Water expands as it moves towards lower pressures. Where a step is so long that it would not
  /// fit its elements, solves it again with the sources that let it out.
  void let_out_expansion(FlowStep<Dim>& step);
  /// Whether the flow has no start-up: of water without compressibility and inertia.
  [[nodiscard]] bool flows_at_once() const;
  [[nodiscard]] bool starts_at_rest() const;
  /// Volume per element, m3, that a step of `dt` would have to let out in addition. Empty where the
  /// step is short or lets out enough.
  [[nodiscard]] std::vector<double> excess_in(const MixedStep<Dim>& step, double dt) const;
  void follow_soils() {
    if (solid_.moves()) {
      scheme_.follow(flow_soils(this->scene(), solid_.soils(), solid_.filling()));
    }
  }
  /// Coefficients at a time within the interval, as erosion will have made them.
  [[nodiscard]] FlowCoefficients<Dim> coefficients_at(const FlowInterval<Dim>& interval,
                                                      double time) const;
  [[nodiscard]] double error_of(const MixedStep<Dim>& step, double start, double dt) const;
  /// The steady flow over `dt` seconds more, with the sources that let out what water expands by in
  /// that time. Nothing, and no more reuse, where these change the flow by too much.
  [[nodiscard]] std::optional<MixedStep<Dim>> steady_step(double dt);
  void remember(MixedStep<Dim> step, double dt);
  /// A step of `dt` ended on a breakpoint at `time`: the flow may have a kink there.
  void pass_breakpoint(double time, double dt);
  /// From here on the flow is reused, if it has become steady and nothing that drives it will
  /// change by itself.
  void reuse_if_steady(double time);
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

  FlowOptions options_;
  const Skeleton<Dim>& solid_;
  ImplicitMixed<Dim> scheme_;
  bool has_gravity_;
  bool follows_pores_;  ///< coefficients change with porosity within a step

  StepControl control_;
  CoefficientBlending<Dim> blending_;
  MassRelaxation relaxation_;
  SteadyReuse<Dim> reuse_;
  FlowScales scales_;

  MixedFlow<Dim> now_;
  /// At the start of the last step, for the prediction of the next; none after a kink.
  std::optional<MixedFlow<Dim>> previous_;
  std::vector<double> pressure_;  ///< per element, Pa
  double eos_error_ = 0.0;

  PassTiming solving_{"flow", 0, 0.0};
  PassTiming reusing_{"flow, steady and kept", 0, 0.0};
};

}  // namespace suffuse
