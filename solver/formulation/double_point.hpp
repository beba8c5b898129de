#pragma once

/// The double-point formulation with a rigid skeleton: solid points stay and erode, liquid points
/// carry water and fluidised grains through the pores between them.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "driver/plan.hpp"
#include "flow/explicit_flow.hpp"
#include "flow/flow_solver.hpp"
#include "formulation/balance.hpp"
#include "transport/carried_liquid.hpp"
#include "transport/grain_transfer.hpp"
#include "transport/lagrangian.hpp"

namespace suffuse {

/// Everything conserved, at one moment.
template <int Dim>
struct DoublePointState {
  double time = 0.0;
  std::vector<double> porosity;  ///< per solid point
  LiquidPoints<Dim> liquid;
  InflowAccount entering;
  std::vector<double> pending;       ///< grains that wait at nodes for liquid, m3
  std::vector<CrossedSums> crossed;  ///< per account: model, then regions
  double empty_total = 0.0;          ///< empty elements, added up over the times points moved

  void archive(auto& archive) {
    archive(time, porosity, liquid, entering, pending, crossed, empty_total);
  }
};

/// Two ways to integrate the flow (scene key `flow.integration`).
///
/// Mixed: nodes and elements keep velocity and pressure, as in the single-point formulation, and
/// liquid points follow the flux; they move when transport asks for it, over many flow steps.
///
/// Material-point, the paper's: liquid points keep velocity and pressure. In each step nodes take
/// their velocity from the points (mass-weighted), elements their pressure (volume-weighted),
/// points take back the change of both (FLIP) and move. Erosion acts before and after as many steps
/// as transport allows, half of its time each.
template <int Dim>
class DoublePoint {
 public:
  using State = DoublePointState<Dim>;
  using Moment = FlowState<Dim>;

  DoublePoint(const Case<Dim>& c, const Plan& plan);

  /// The model at a time between steps.
  struct Observation {
    State state;
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

  /// Where liquid points carry the flow they are put together here, for those who ask.
  [[nodiscard]] const State& state() const;
  [[nodiscard]] double time() const { return state_.time; }
  [[nodiscard]] FlowState<Dim> moment() const { return flow_->moment(state_.time); }
  [[nodiscard]] const FlowSolver<Dim>& flow() const { return *flow_; }
  [[nodiscard]] const Grid<Dim>& grid() const { return grid_; }

  [[nodiscard]] HistoryRow history_row(const State& state, const FlowState<Dim>& moment) const;
  [[nodiscard]] LedgerRow ledger(const State& state) const;
  [[nodiscard]] std::vector<RegionRow> region_rows(const State& state) const;
  [[nodiscard]] Snapshot snapshot(const State& state, const FlowState<Dim>& moment,
                                  long step) const;
  [[nodiscard]] long liquid_points() const {
    return carried_ ? carried_->blocks().size() : state_.liquid.size();
  }

  /// Everything that intervals to come depend on: what is restored goes on as if it had not been
  /// interrupted, to the last bit.
  void archive(StateArchive& archive);

  [[nodiscard]] std::vector<PassTiming> passes() const;
  /// Things to say once, newly found.
  [[nodiscard]] std::vector<std::string> take_warnings();

 private:
  struct PassTimings {
    PassTiming erosion{"erosion and transfer of grains", 0, 0.0};
    PassTiming movement{"movement of liquid points", 0, 0.0};
    PassTiming coefficients{"coefficients of the flow", 0, 0.0};

    void archive(auto& archive) { archive(erosion, movement, coefficients); }
  };
  using HasLiquid = std::function<bool(int element)>;
  /// Volume of grains and of all liquid at p = 0, per element, m3.
  struct LiquidContent {
    std::vector<double> grains;
    std::vector<double> liquid;
  };
  void initialise();
  void place_liquid();
  [[nodiscard]] InjectionSettings birth_settings() const;
  [[nodiscard]] std::vector<double> element_porosity(const std::vector<double>& porosity) const;
  [[nodiscard]] std::vector<double> point_volumes(const LiquidPoints<Dim>& liquid,
                                                  const std::vector<double>& pressure) const;
  [[nodiscard]] long steps_before_transport(double dt) const;
  [[nodiscard]] LiquidContent liquid_content() const;
  /// What the pores hold now.
  [[nodiscard]] PoreState pores() const;
  /// The pores at a time ahead, as erosion fills them, before points have moved.
  [[nodiscard]] PoreState pores_at(double time) const;
  /// Concentrations as the weight of the liquid feels them, from those of the elements and their
  /// liquid volumes: a point that crosses a face would be a jump of the buoyancy, and free water,
  /// which next to nothing resists, would answer it with eddies of its own. In soil they are
  /// smoothed over the elements around, free water is taken as well mixed.
  [[nodiscard]] std::vector<double> weighed_concentration(std::vector<double> concentration,
                                                          const std::vector<double>& volume) const;
  /// |q| at solid points (empty when no soil erodes by it), m/s.
  /// |q| at solid points (empty when no soil erodes by it), m/s.
  [[nodiscard]] std::vector<double> point_flux(const LiquidMotion<Dim>& motion) const;
  [[nodiscard]] std::vector<double> point_flux(const FluxInTime& flux) const;
  /// How the liquid will move over the next `ahead` seconds, for soils that erode by the flux.
  [[nodiscard]] LiquidMotion<Dim> motion_ahead(double ahead) const;
  void update_flow();
  [[nodiscard]] LiquidMotion<Dim> motion(const Passed<Dim>& passed, double duration) const;
  /// What erosion and transport make of `begin` while the liquid moves so.
  [[nodiscard]] State advanced(State state, const LiquidMotion<Dim>& motion,
                               const std::vector<double>& flux, const std::vector<double>& pressure,
                               PassTimings& timings) const;
  /// The same where points follow the volumes through faces and take up grains on their way.
  [[nodiscard]] State followed(State state, const LiquidMotion<Dim>& motion,
                               const std::vector<double>& flux, const std::vector<double>& pressure,
                               PassTimings& timings) const;
  /// Ends of the pieces, as shares of the motion, in each of which porosity goes smoothly and no
  /// point goes too far.
  [[nodiscard]] std::vector<double> pieces(const State& state,
                                           const LiquidMotion<Dim>& motion) const;
  void follow(State& state, const LiquidMotion<Dim>& part, const std::vector<double>& flux,
              const std::vector<double>& pressure, PassTimings& timings) const;
  [[nodiscard]] double substeps(const LiquidMotion<Dim>& motion, double begin,
                                const std::vector<double>& porosity) const;
  /// An interval whose liquid is carried: half of its erosion before the steps, half after them.
  void start_carried(double duration);
  void finish_carried(double end);
  void erode_carried(double from, double to, const std::vector<double>& flux);
  void book_carried(const std::vector<CarriedCrossing>& crossings);
  /// The state at a time within the interval, aside.
  [[nodiscard]] State look_at_carried(const FlowState<Dim>& moment) const;
  [[nodiscard]] State look_at_followed(const FlowState<Dim>& moment,
                                       const Passed<Dim>& passed) const;
  /// Solid can erode meanwhile, or grains wait for liquid.
  [[nodiscard]] bool has_to_erode(const State& state, double from, double to) const;
  void erode(State& state, double from, double to, const std::vector<double>& flux,
             const std::vector<double>& pressure) const;
  void move(State& state, const LiquidMotion<Dim>& motion,
            const std::vector<double>& pressure) const;
  [[nodiscard]] std::vector<double> eroded_porosity(const std::vector<double>& porosity,
                                                    double from, double to,
                                                    const std::vector<double>& flux,
                                                    const HasLiquid& has_liquid) const;
  void book(const typename GrainTransfer<Dim>::Result& exchanged, State& state) const;
  void book(const PointCrossing& point, State& state) const;
  /// When some soil begins to erode, or all of it at once has no fines left.
  [[nodiscard]] std::vector<double> bends_of_porosity() const;
  [[nodiscard]] std::vector<double> concentrations(const LiquidPoints<Dim>& liquid,
                                                   const std::vector<double>& volume) const;
  [[nodiscard]] double interpolated(const LiquidPoints<Dim>& liquid, int p,
                                    const std::vector<double>& at_nodes) const;
  [[nodiscard]] double point_pressure_scatter(const LiquidPoints<Dim>& liquid,
                                              const std::vector<double>& volume,
                                              const std::vector<double>& smooth) const;
  [[nodiscard]] int empty_elements(const HasLiquid& has_liquid) const;
  [[nodiscard]] int empty_elements(const std::vector<int>& begins) const {
    return empty_elements([&](int e) { return begins[e + 1] > begins[e]; });
  }
  [[nodiscard]] std::vector<Stored> stored(const State& state) const;
  /// Where points are, with the pressure and the velocity there.
  void add_places(const State& state, const FlowState<Dim>& moment, Snapshot& result) const;

  const Case<Dim>& case_;
  const Plan& plan_;
  Grid<Dim> grid_;
  RigidSkeleton<Dim> skeleton_;
  std::unique_ptr<FlowSolver<Dim>> flow_;
  ExplicitFlow<Dim>* carried_flow_;  ///< the same where liquid points carry it, else null
  BoundaryAccounts<Dim> accounts_;
  LiquidDensities densities_;

  LagrangianTransport<Dim> transport_;
  GrainTransfer<Dim> transfer_;
  /// Without liquid points while these carry the flow, but for those who ask.
  mutable State state_;
  std::unique_ptr<CarriedLiquid<Dim>>
      carried_;  ///< the liquid where it carries the flow, else null
  /// Where the interval of a carried liquid began and erosion stands meanwhile; the state as it
  /// would be without that erosion, which is what a look before its time goes on from.
  struct CarriedInterval {
    double begin = 0.0;
    double middle = 0.0;
    State not_eroded;
  };
  CarriedInterval carried_interval_;
  std::vector<Stored> initial_;
  std::vector<double> initial_pores_;  ///< volume per element, m3
  std::vector<double> bends_;          ///< see bends_of_porosity, ascending, s
  double last_dt_ = 0.0;
  LiquidMotion<Dim> last_motion_;
  std::vector<double> end_rate_;  ///< per face at its end, where soil erodes by the flux, m3/s
  long last_steps_ = 1;
  long steps_ = 0;

  PassTimings timings_;
};

}  // namespace suffuse
