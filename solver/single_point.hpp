#pragma once

/// The single-point formulation with a rigid skeleton: every material point stands for soil and
/// liquid at once. Flow, erosion and transport advance together over one interval: many flow steps,
/// as many transport steps as their own limit asks for.

#include <string>
#include <vector>

#include "balance.hpp"
#include "flow/explicit_nodal.hpp"
#include "plan.hpp"
#include "results/writer.hpp"
#include "solid/rigid_skeleton.hpp"
#include "transport/eulerian.hpp"

namespace suffuse {

/// Everything conserved, at one moment.
template <int Dim>
struct SinglePointState {
  double time = 0.0;
  std::vector<double> porosity;    ///< per solid point
  FinesState<Dim> liquid;          ///< pores and grains in them, per element and field node, m3
  std::vector<double> water_mass;  ///< per element, kg
  std::vector<Crossed> crossed;    ///< per account: model, then regions
};

/// The flow at one moment.
template <int Dim>
struct FlowMoment {
  double time = 0.0;
  double dt = 0.0;
  std::vector<double> pressure;  ///< per element, Pa
  VectorField<Dim> velocity;     ///< per node, intrinsic, m/s
};

template <int Dim>
class SinglePoint {
 public:
  SinglePoint(const Case<Dim>& c, const Plan& plan, const SolverOptions& options);

  struct Interval {
    SinglePointState<Dim> begin;
    SinglePointState<Dim> end;
    std::vector<FlowMoment<Dim>> moments;  ///< one per observation time
  };
  /// Runs the flow `steps` times `dt`, noting it at `observation_times` (ascending, within the
  /// interval), then lets erosion and transport catch up.
  Interval advance(long steps, double dt, const std::vector<double>& observation_times);

  /// Flow steps of `dt` that transport lets pass before it must run.
  [[nodiscard]] long steps_before_transport(double dt) const;

  /// Stability limit with the coefficients of this moment.
  [[nodiscard]] StabilityLimit current_limit() const;

  [[nodiscard]] const SinglePointState<Dim>& state() const { return state_; }
  [[nodiscard]] FlowMoment<Dim> moment() const;

  /// Conserved state between the ends of an interval: erosion by its law, the rest on straight
  /// lines, so that balances close as they do at the ends.
  [[nodiscard]] SinglePointState<Dim> state_at(const Interval& interval, double time) const;

  [[nodiscard]] HistoryRow history_row(const SinglePointState<Dim>& state,
                                       const FlowMoment<Dim>& moment) const;
  [[nodiscard]] LedgerRow ledger(const SinglePointState<Dim>& state) const;
  [[nodiscard]] std::vector<RegionRow> region_rows(const SinglePointState<Dim>& state) const;
  [[nodiscard]] Snapshot snapshot(const SinglePointState<Dim>& state, const FlowMoment<Dim>& moment,
                                  long step) const;

  [[nodiscard]] std::vector<PassTiming> passes() const;
  /// Things to say once, newly found.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  void initialise();
  void update_flow();
  void catch_up(double duration);
  void move_water(const std::vector<double>& grains_crossed);
  [[nodiscard]] std::vector<Stored> stored(const SinglePointState<Dim>& state) const;
  [[nodiscard]] std::vector<double> face_fluxes(const VectorField<Dim>& velocity) const;
  void warn_of_unstated_inflow();

  const Case<Dim>& case_;
  const Plan& plan_;
  Grid<Dim> grid_;
  std::vector<FaceCondition> conditions_;
  RigidSkeleton<Dim> skeleton_;
  NodalOperator<Dim> operator_;
  ExplicitNodal<Dim> flow_;
  EulerianTransport<Dim> transport_;
  BoundaryAccounts<Dim> accounts_;
  FlowCoefficients<Dim> coefficients_;
  SinglePointState<Dim> state_;
  std::vector<Stored> initial_;
  double grain_density_ = unset;
  double last_dt_ = 0.0;
  std::vector<double> last_volume_rate_;  ///< per face over the last interval, m3/s
  long last_steps_ = 1;
  std::vector<bool> inflow_warned_;
  std::vector<std::string> warnings_;
  PassTiming flow_pass_{"flow", 0, 0.0};
  PassTiming erosion_pass_{"erosion", 0, 0.0};
  PassTiming transport_pass_{"transport", 0, 0.0};
  PassTiming water_pass_{"water masses and coefficients", 0, 0.0};
};

}  // namespace suffuse
