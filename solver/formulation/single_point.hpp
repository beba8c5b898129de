#pragma once

/// The single-point formulation with a rigid skeleton: every material point stands for soil and
/// liquid at once. Flow, erosion and transport advance together over one interval: many flow steps,
/// as many transport steps as their own limit asks for.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "driver/plan.hpp"
#include "flow/flow_solver.hpp"
#include "formulation/balance.hpp"
#include "results/writer.hpp"
#include "solid/rigid_skeleton.hpp"
#include "transport/eulerian.hpp"

namespace suffuse {

/// Everything conserved, at one moment.
template <int Dim>
struct SinglePointState {
  double time = 0.0;
  std::vector<double> porosity;      ///< per solid point
  FinesState<Dim> liquid;            ///< pores and grains in them, per element and field node, m3
  std::vector<double> water_mass;    ///< per element, kg
  std::vector<CrossedSums> crossed;  ///< per account: model, then regions

  void archive(auto& archive) { archive(time, porosity, liquid, water_mass, crossed); }
};

template <int Dim>
class SinglePoint {
 public:
  using State = SinglePointState<Dim>;
  using Moment = FlowState<Dim>;

  SinglePoint(const Case<Dim>& c, const Plan& plan);

  /// The model at a time between steps.
  struct Observation {
    SinglePointState<Dim> state;
    FlowState<Dim> flow;
  };
  /// Runs the flow to its next meeting with erosion and transport, not beyond `target`, and lets
  /// them catch up. Returns what was to be seen at the times that `times_until` gives (ascending),
  /// asked with the time that is reached; looking changes nothing.
  std::vector<Observation> advance(
      double target, const std::function<std::vector<double>(double reached)>& times_until);
  [[nodiscard]] long steps() const { return steps_; }
  /// Length of the last step of the flow, s.
  [[nodiscard]] double last_step() const { return last_dt_; }
  /// Longest step, s, that erosion and transport leave to a flow that could take any.
  [[nodiscard]] double longest_interval() const;

  [[nodiscard]] const SinglePointState<Dim>& state() const { return state_; }
  [[nodiscard]] double time() const { return state_.time; }
  [[nodiscard]] FlowState<Dim> moment() const { return flow_->moment(state_.time); }
  [[nodiscard]] const FlowSolver<Dim>& flow() const { return *flow_; }

  [[nodiscard]] HistoryRow history_row(const SinglePointState<Dim>& state,
                                       const FlowState<Dim>& moment) const;
  [[nodiscard]] LedgerRow ledger(const SinglePointState<Dim>& state) const;
  [[nodiscard]] std::vector<RegionRow> region_rows(const SinglePointState<Dim>& state) const;
  [[nodiscard]] Snapshot snapshot(const SinglePointState<Dim>& state, const FlowState<Dim>& moment,
                                  long step) const;

  [[nodiscard]] long liquid_points() const { return 0; }

  /// Everything that intervals to come depend on: what is restored goes on as if it had not been
  /// interrupted, to the last bit.
  void archive(StateArchive& archive);

  [[nodiscard]] std::vector<PassTiming> passes() const;
  /// Things to say once, newly found.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  void initialise();
  [[nodiscard]] long steps_before_transport(double dt) const;
  [[nodiscard]] PoreState pores(const SinglePointState<Dim>& state) const;
  /// The pores at a time ahead, as erosion fills them, before grains have moved.
  [[nodiscard]] PoreState pores_at(double time) const;
  /// |q| at solid points (empty when no soil erodes by it), m/s.
  [[nodiscard]] std::vector<double> point_flux(const FluxInTime& flux) const;
  /// |q| per element, m/s, over the last interval.
  [[nodiscard]] std::vector<double> element_flux_magnitude() const;
  [[nodiscard]] int threads() const { return plan_.flow.threads; }
  void update_flow();
  struct PassTimings {
    PassTiming erosion{"erosion", 0, 0.0};
    PassTiming transport{"transport", 0, 0.0};
    PassTiming water{"water masses and coefficients", 0, 0.0};

    void archive(auto& archive) { archive(erosion, transport, water); }
  };
  /// Erosion and transport over `duration` while `volumes` cross the faces.
  void follow(SinglePointState<Dim>& state, const FaceVolumes& volumes, double duration,
              const FluxInTime& flux_in_time, PassTimings& timings);
  /// Books water, and grains as `scratch_` has them, that crossed.
  void move_water(SinglePointState<Dim>& state, const FaceVolumes& volumes);
  /// Pressure and water masses agree after this.
  void synchronise_flow();
  [[nodiscard]] std::vector<Stored> stored(const SinglePointState<Dim>& state) const;

  const Case<Dim>& case_;
  const Plan& plan_;
  Grid<Dim> grid_;
  RigidSkeleton<Dim> skeleton_;
  std::unique_ptr<FlowSolver<Dim>> flow_;
  EulerianTransport<Dim> transport_;
  BoundaryAccounts<Dim> accounts_;
  SinglePointState<Dim> state_;
  std::vector<Stored> initial_;
  double grain_density_ = unset;
  double last_dt_ = 0.0;
  std::vector<double> last_volume_rate_;  ///< per face over the last interval, m3/s
  std::vector<double> end_rate_;          ///< at its end, where soil erodes by the flux
  double last_duration_ = 1.0;            ///< of it, s
  long last_steps_ = 1;
  long steps_ = 0;
  PassTimings timings_;

  /// What `follow` works with: of the interval, or of a look aside.
  struct Scratch {
    TransportScratch<Dim> transport;
    ElementField<Dim> eroded;            ///< in a step of transport, m3
    std::vector<double> step_volume;     ///< liquid per face in a step of transport, m3
    std::vector<double> grains_crossed;  ///< per face, m3
    std::vector<double> water;           ///< likewise, kg
    std::vector<double> fines;           ///< likewise, kg
    std::vector<double> face_concentration;
  };
  Scratch scratch_;
};

}  // namespace suffuse
