#pragma once

/// The implicit flow of a scene (`scheme = "implicit"`): mixed finite elements, with steps by the
/// scene's tolerance or of its given length. A step is tried, judged by its error, and accepted or
/// shortened. A steady flow is reused and not solved again. Classes of their own take these
/// decisions.

#include <optional>
#include <vector>

#include "bounds/flow_errors.hpp"
#include "flow/coefficient_blending.hpp"
#include "flow/flow_scales.hpp"
#include "flow/flow_solver.hpp"
#include "flow/mass_relaxation.hpp"
#include "flow/steady_reuse.hpp"
#include "flow/step_control.hpp"
#include "mixed/implicit_mixed.hpp"
#include "mixed/mixed_flow.hpp"

namespace suffuse {

/// Data of a moving solid that the flow needs at the start.
struct MovingSolid {
  double load_change = 0.0;             ///< largest change of tractions in the run, Pa
  double stiffness = 0.0;               ///< largest modulus of soil that cannot move sideways, Pa
  std::vector<double> compressibility;  ///< per element, m3/Pa
  /// Time in which the soil moves at the start, s: unstable soil falls through an element, or soil
  /// is dug out or filled in; 0: it is in equilibrium.
  double time_of_change = 0.0;
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
  /// Call after `start` or `start_from` if the solid moves: chooses the first step.
  void start_steps(const MovingSolid& solid);

  /// One step. Throws NumericalError when no step is short enough for the tolerance.
  FlowStep<Dim> solve(const FlowInterval<Dim>& interval) override;
  FlowProgress commit(FlowStep<Dim> step) override;

  // Parts of `solve`, for a caller that solves for the solid in the same step (coupling/).

  /// The step to try first, without forcing and result.
  [[nodiscard]] FlowStep<Dim> propose(const FlowInterval<Dim>& interval);
  /// Sets coefficients, boundary values and sources at each stage of the step.
  void set_forcing(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) const;
  /// Whether the solution is accurate enough; else shortens the step. Throws as `solve` does.
  [[nodiscard]] bool accepts(const FlowInterval<Dim>& interval, FlowStep<Dim>& step);
  /// Gives a long step sources that let out the expansion of water that moves to lower pressures,
  /// where its elements could not hold it. Returns whether the step is to be solved again.
  [[nodiscard]] bool let_out_expansion(FlowStep<Dim>& step) const;
  /// Shortens a step that has no solution. Throws as `solve` does.
  void reject(FlowStep<Dim>& step) { control_.reject(step.start, step.dt); }
  /// Plans the step again after the solid got inertia, at least as long as the last one.
  void plan_anew(const FlowInterval<Dim>& interval, FlowStep<Dim>& step) const;
  /// Whether a step without a solution is too short to be shortened.
  [[nodiscard]] bool is_shortest(const FlowStep<Dim>& step) const;

  [[nodiscard]] ImplicitMixed<Dim>& scheme() { return scheme_; }
  [[nodiscard]] const ImplicitMixed<Dim>& scheme() const { return scheme_; }
  /// Time and calls of `solve`.
  [[nodiscard]] PassTiming& timing() { return solving_; }
  [[nodiscard]] const MixedState<Dim>& mixed_state() const { return now_.state; }
  /// Relative to which errors of pressures are, Pa.
  [[nodiscard]] double pressure_scale() const { return scales_.pressure; }
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
  /// Lets water that does not fit an element's pores at its pressure out in the next steps.
  void match_masses(double time, const std::vector<double>& water_mass) override;

  void archive(StateArchive& archive) override;

  [[nodiscard]] FlowState<Dim> state(double time) const override;
  [[nodiscard]] std::optional<DischargeBounds> discharge_bounds() const override;
  [[nodiscard]] std::vector<double> face_flux(double /*time*/) const override {
    return now_.face_flux;
  }
  [[nodiscard]] std::vector<PassTiming> passes() const override;

 private:
  /// Starts from this flow or, unless the run starts at rest, from the steady one. `air`: null to
  /// derive it from the pressures.
  void start_with(MixedFlow<Dim> flow, const ElementField<Dim>* air);
  /// Solves for a step of this length and for levels of reservoirs that agree with it. Returns the
  /// reason if there is no solution.
  [[nodiscard]] std::optional<Unsolved> try_step(const FlowInterval<Dim>& interval,
                                                 FlowStep<Dim>& step);
  [[nodiscard]] MixedStep<Dim> solved(const FlowStep<Dim>& step);
  /// Whether the flow follows its forcing at once: no compressibility, inertia or retention.
  [[nodiscard]] bool flows_at_once() const;
  [[nodiscard]] bool starts_at_rest() const;
  /// Additional volume per element, m3, that a step of `dt` would have to let out. Empty if the
  /// step is short or lets out enough.
  [[nodiscard]] std::vector<double> excess_in(const MixedStep<Dim>& step, double dt) const;
  void follow_soils() {
    if (solid_.moves()) {
      scheme_.follow(flow_soils(this->scene(), solid_, this->coefficients_.porosity));
    }
  }
  /// Coefficients with pores that are forecast for a time.
  [[nodiscard]] FlowCoefficients<Dim> coefficients_at(double time, PoreState pores) const;
  [[nodiscard]] double error_of(const MixedStep<Dim>& step, double start, double dt) const;
  /// The steady flow over `dt` more seconds, with sources for the expansion of water in that time.
  /// If these change the flow too much, ends the reuse and returns nothing.
  [[nodiscard]] std::optional<MixedStep<Dim>> steady_step(double dt);
  void remember(MixedStep<Dim> step, double dt);
  /// Call when a step of `dt` ended on a breakpoint at `time`: the flow may have a kink there.
  void pass_breakpoint(double time, double dt);
  /// Starts to reuse the flow if it has become steady and nothing that drives it will change by
  /// itself.
  void reuse_if_steady(double time);
  /// Solves the steady flow again if its sources have changed.
  void update_steady_flow();
  /// Solves the steady flow with this source, m3/s per element. If that changes the flow too much,
  /// keeps the flow, ends the reuse and returns false.
  bool take_steady_flow(std::vector<double> source);
  /// Takes the pressures and fluxes of a steady flow; the air does not change.
  void replace_flow(MixedStep<Dim> steady) {
    steady.end.air = std::move(now_.state.air);
    now_ = end_of(std::move(steady));
  }
  [[nodiscard]] std::vector<double> element_pressure_now() const {
    return element_pressure(this->grid(), now_.state.face_pressure, this->threads());
  }
  [[nodiscard]] double filling_time() const {
    return suffuse::filling_time(this->grid(), this->coefficients_, scheme_.soils().air_moves(),
                                 now_.face_flux);
  }
  /// A time that is short compared with all time scales of the flow, s: a step of this length ends
  /// in the state right after the start. Infinite if nothing delays the flow. `soil_storage`: see
  /// `fastest_rate`.
  [[nodiscard]] double shortest_change(const std::vector<double>& soil_storage) const;

  FlowOptions options_;
  const Skeleton<Dim>& solid_;
  ImplicitMixed<Dim> scheme_;
  bool has_gravity_;
  bool follows_pores_;  ///< coefficients depend on porosity within a step

  StepControl control_;
  CoefficientBlending<Dim> blending_;
  MassRelaxation relaxation_;
  SteadyReuse<Dim> reuse_;
  FlowScales scales_;

  MixedFlow<Dim> now_;
  /// Flow at the start of the last step, to predict the next one; none after a kink.
  std::optional<MixedFlow<Dim>> previous_;
  std::vector<double> pressure_;  ///< per element, Pa
  double eos_error_ = 0.0;
  mutable FlowErrors<Dim> errors_;

  PassTiming solving_{"flow", 0, 0.0};
  PassTiming reusing_{"flow, steady and kept", 0, 0.0};
};

}  // namespace suffuse
