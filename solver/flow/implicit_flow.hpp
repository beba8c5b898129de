#pragma once

/// The implicit flow of a scene (`scheme = "implicit"`): mixed finite elements with steps chosen by
/// the scene's tolerance, or given by it. A flow that no longer changes is kept, not solved again.

#include <optional>
#include <vector>

#include "flow/flow_solver.hpp"
#include "flow/implicit_mixed.hpp"

namespace suffuse {

template <int Dim>
class ImplicitFlow final : public FlowSolver<Dim> {
 public:
  ImplicitFlow(const Case<Dim>& c, const Grid<Dim>& grid, const Skeleton<Dim>& solid,
               const FlowOptions& options);

  void update(double time, const PoreState& pores,
              const std::vector<double>& face_concentration) override;
  void start() override;
  /// One step. Throws NumericalError when no step is short enough for the tolerance.
  FlowProgress advance(const FlowInterval<Dim>& interval) override;
  [[nodiscard]] typename FlowSolver<Dim>::CouplingLimits coupling_limits() const override {
    return {.one_transport_step = false, .follows_pores = true};
  }

  [[nodiscard]] const std::vector<double>& pressure() const override { return pressure_; }
  /// Where an element's water does not fit its pores at its pressure, the next step lets it out.
  void match_masses(double time, const std::vector<double>& water_mass) override;

  void archive(StateArchive& archive) override;

  [[nodiscard]] FlowState<Dim> state(double time) const override;
  [[nodiscard]] std::vector<double> face_flux(double /*time*/) const override {
    return now_.face_flux;
  }
  [[nodiscard]] std::vector<PassTiming> passes() const override;

 private:
  /// The flow at one end of a step.
  struct Point {
    MixedState<Dim> state;
    std::vector<double> face_flux;     ///< m3/s
    std::vector<double> flux_through;  ///< see MixedStep: errors and scales are of this

    void archive(auto& archive) { archive(state, face_flux, flux_through); }
  };

  void find_forcing(const FlowInterval<Dim>& interval, double time,
                    FlowForcing<Dim>& forcing) const;
  /// Coefficients at a time within the interval, as erosion will have made them.
  [[nodiscard]] FlowCoefficients<Dim> coefficients_at(const FlowInterval<Dim>& interval,
                                                      double time) const;
  /// Boundary values jump within these `dt` seconds.
  [[nodiscard]] bool jumps(double begin, double dt) const;
  /// Length of the step that is tried next, s.
  [[nodiscard]] double length_of_step(double begin, double until, double longest) const;
  /// After a step of `dt` that ended at `time`: what a breakpoint there ends, or a steady flow
  /// starts.
  void meet_breakpoint(double time, double dt);
  /// Makes the coefficients at `time` go on from those at the end of the last step: what transport
  /// made of them meanwhile would be a jump of the flux that no step is too short for.
  void join_to_last_step(double begin, double time, FlowCoefficients<Dim>& coefficients) const;
  /// Compares the coefficients with what the last step took them to be: the next is shortened
  /// where resistances were not, and knows how the density drifts.
  void learn_from_expected();
  /// Estimated local error of a step over the tolerance.
  [[nodiscard]] double error_of(const MixedStep<Dim>& step, double dt) const;
  [[nodiscard]] MixedStep<Dim> accepted_step(const FlowInterval<Dim>& interval, double& dt);
  /// The same flow again, over `dt`.
  [[nodiscard]] MixedStep<Dim> kept(double dt) const;
  [[nodiscard]] FaceVolumes volumes_of(const MixedStep<Dim>& step) const;
  void remember(MixedStep<Dim> step, double dt);
  /// Keeps the flow when it has become steady and nothing that drives it will change by itself.
  void keep_if_steady(double time);
  /// The kept flow with what its mismatch of masses asks for by now; no longer kept when that is
  /// too much.
  void mend_kept();
  /// Time in which the largest flux fills the pores of the smallest element, s; infinite at rest.
  [[nodiscard]] double time_through_an_element() const;
  /// Outflow per element that keeps water and pores in step and makes up for the mismatch so far,
  /// for a step of `dt`, m3/s.
  [[nodiscard]] std::vector<double> source_with(double dt) const;
  [[nodiscard]] bool same_resistance(const FlowCoefficients<Dim>& a,
                                     const FlowCoefficients<Dim>& b) const;
  void find_scales();
  void raise_scales_over_round_off();
  [[nodiscard]] std::vector<double> element_means(const std::vector<double>& face_pressure) const;
  [[nodiscard]] FlowState<Dim> moment_of(double time, double dt, const Point& flow,
                                         const std::vector<double>& porosity) const;
  [[nodiscard]] double overshoot(const std::vector<double>& face_pressure) const;
  void warn_of_obtuse_angles();

  FlowOptions options_;
  double tolerance_;
  double end_;
  ImplicitMixed<Dim> scheme_;
  bool follows_pores_;  ///< coefficients change with porosity within a step

  std::vector<FlowForcing<Dim>> forcing_;  ///< per stage of the step that is tried
  FlowCoefficients<Dim> used_;             ///< at the end of the last step that was solved
  /// At the end of the last step that was solved as its begin let expect them.
  std::optional<FlowCoefficients<Dim>> expected_;
  /// Of the mixture, per element: how much faster it rose in the last step than expected (what
  /// flowed there), kg/(m3 s).
  std::vector<double> density_drift_;
  double joining_ = 0.0;  ///< time in which steps join what transport changed, the last or more, s

  Point now_;
  std::vector<double> pressure_;  ///< per element, Pa
  double last_dt_ = 0.0;
  double mending_ = 0.0;  ///< time in which steps change the source, the last or more, s
  double next_dt_ = 0.0;
  /// Flux and pressure at the begin of the last step, for the prediction of the next; empty when
  /// there is none.
  std::optional<Point> before_;
  bool at_rest_ = true;  ///< fluxes at the start do not belong to the pressures yet
  double flux_scale_ = 0.0;
  bool knows_flux_scale_ = false;  ///< from what the boundary conditions can drive
  double pressure_scale_ = 0.0;
  double lowest_bound_ = 0.0;  ///< pressures of boundaries and start, Pa
  double highest_bound_ = 0.0;
  bool has_bounds_ = false;

  bool keep_ = false;
  FlowCoefficients<Dim> kept_coefficients_;

  std::vector<double> mismatch_;      ///< water too much per element, m3
  std::vector<double> outflow_rate_;  ///< that keeps it from growing: moving water expands, m3/s
  std::vector<double> source_;        ///< of the last step, m3/s
  double eos_error_ = 0.0;

  PassTiming solving_{"flow", 0, 0.0};
  PassTiming keeping_{"flow, steady and kept", 0, 0.0};
  long rejected_ = 0;
};

}  // namespace suffuse
