#pragma once

/// The model of a run, which the driver advances from output to output: common base of the
/// single-point and double-point formulations. Each has its own `advance`.

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "coupling/construction_stage.hpp"
#include "coupling/coupled_flow.hpp"
#include "field/solid_exchange.hpp"
#include "field/transport.hpp"
#include "formulation/earlier_state.hpp"
#include "formulation/masses.hpp"
#include "formulation/observations.hpp"
#include "motion/make_skeleton.hpp"
#include "results/writer.hpp"
#include "solid/pores.hpp"
#include "solid/rank_state.hpp"

namespace suffuse {

/// Parts of a model that are run or skipped, decided by the plan of the run.
struct ModelOptions {
  FlowOptions flow;
  bool erosion = true;
  bool transport = true;  ///< fines can be in the liquid
  /// Times between which the solid can change, and after which the liquid can hold fines, s.
  TimeSpan erosion_span;
  double fines_from = -std::numeric_limits<double>::infinity();
  /// Later: `start_from` or `archive` follows.
  SoilStart soil_start = SoilStart::finds_stress;
  /// The part of this rank, to which the case belongs; null: this program is alone.
  std::shared_ptr<const RankPart> part;
};

template <int Dim>
class TwoPhaseModel {
 public:
  virtual ~TwoPhaseModel() = default;
  TwoPhaseModel(const TwoPhaseModel&) = delete;
  TwoPhaseModel& operator=(const TwoPhaseModel&) = delete;

  /// Replaces the initial state by the last state of another run with the same formulation and
  /// mesh, and the same solid points unless they have moved. Time stays 0, and the accounts start
  /// with these masses.
  virtual void start_from(const EarlierState<Dim>& earlier) = 0;
  /// The present state, for another run.
  [[nodiscard]] virtual EarlierState<Dim> last_state() const = 0;

  /// Advances flow, erosion and transport by one interval, to `latest` (s, the next output) or to
  /// an earlier time. Throws NumericalError.
  virtual void advance(double latest) = 0;

  /// Sets the next step of the flow to `dt`, s. Only estimates use this.
  void plan_step(double dt) { flow_->plan_step(dt); }

  /// The ranks that share the run: all have to make the same calls of the model.
  [[nodiscard]] const Ranks& ranks() const { return grid_.ranks(); }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] long steps() const { return steps_; }
  /// Length of the last step of the flow, s.
  [[nodiscard]] double last_step() const { return last_dt_; }
  /// Longest interval of the flow that erosion and transport allow, s.
  [[nodiscard]] double coupling_interval() const;
  /// Explicit steps of transport in `duration`, s, at the flow of the last interval.
  [[nodiscard]] double explicit_transport_steps(double duration) const {
    return duration / transport().longest_explicit_step(flux_history_.mean);
  }
  [[nodiscard]] virtual long liquid_points() const { return 0; }

  [[nodiscard]] const Grid<Dim>& grid() const { return grid_; }
  [[nodiscard]] const Skeleton<Dim>& solid() const { return *solid_; }
  [[nodiscard]] const FlowSolver<Dim>& flow() const { return *flow_; }
  [[nodiscard]] const CoupledFlow<Dim>& coupled_flow() const { return *coupled_; }
  [[nodiscard]] FlowState<Dim> flow_state() const;

  // Present values for the results.
  [[nodiscard]] virtual HistoryRow history_row(const FlowState<Dim>& flow) const = 0;
  [[nodiscard]] LedgerRow ledger() const { return masses_.ledger(time_, stored()); }
  [[nodiscard]] std::vector<RegionRow> region_rows() const;
  [[nodiscard]] std::vector<BoundaryRow> boundary_rows(const FlowState<Dim>& flow) const;
  [[nodiscard]] std::vector<ProbeRow> probe_rows(const FlowState<Dim>& flow) const;
  [[nodiscard]] std::vector<SectionRow> section_rows(const FlowState<Dim>& flow) const;
  [[nodiscard]] virtual Snapshot snapshot(const FlowState<Dim>& flow) const = 0;

  /// Stores or restores the whole state: a restored run gives the same bits as one without
  /// interruption.
  virtual void archive(StateArchive& archive);
  /// How ranks share the state; null: this program is alone.
  [[nodiscard]] const SharedState* shared_state() const { return shared_state_.get(); }
  [[nodiscard]] virtual std::vector<PassTiming> passes() const = 0;
  /// Warnings since the last call.
  [[nodiscard]] std::vector<std::string> take_warnings() { return flow_->take_warnings(); }

 protected:
  TwoPhaseModel(const Case<Dim>& c, const ModelOptions& options);

  /// The transport of liquid and fines.
  [[nodiscard]] virtual const Transport<Dim>& transport() const = 0;
  [[nodiscard]] virtual PoreState pores() const = 0;
  /// Pores and fines in them, for the results.
  [[nodiscard]] virtual FinesState<Dim> fines_state(const FlowState<Dim>& flow) const = 0;
  /// Masses inside the model, then inside each region.
  [[nodiscard]] virtual std::vector<Stored> stored() const = 0;

  [[nodiscard]] const Scene& scene() const { return case_.document.scene; }
  [[nodiscard]] int threads() const { return options_.flow.threads; }
  [[nodiscard]] PoreForecast<Dim> pore_forecast();
  /// Finds the present concentration and saturation of the liquid at the solid points.
  virtual void find_liquid(PointFlows& flows) const = 0;
  /// Sets the flow of this formulation and couples it with the solid.
  void set_flow(std::unique_ptr<FlowSolver<Dim>> flow);
  /// To be called when the flow has started.
  void start_flux_history();
  /// Starts the solid from another run. Returns the elements whose soil was dug out or filled in.
  std::vector<int> start_solid(const EarlierState<Dim>& earlier);
  /// The soil for another run; nothing if it does not move.
  [[nodiscard]] std::optional<MovedSoil<Dim>> last_moved() const {
    if (!solid_phase_.moving) return std::nullopt;
    return solid_phase_.moving->moved();
  }
  /// Starts the flow from another run, after the solid; `update` sets the pores of the flow.
  template <class Update>
  void start_flow(const EarlierState<Dim>& earlier, const Update& update) {
    update();
    coupled_->start_from(earlier.flow,
                         earlier.moved ? SoilStart::has_stress : SoilStart::finds_stress);
    update();
    start_flux_history();
  }
  /// Takes the fluxes of an interval of the flow from `start`, s, for erosion and deposition.
  void start_exchange(double start, const FlowProgress& flow);
  /// Books the liquid that has crossed boundaries and sections, and counts the steps of the flow.
  /// Throws NumericalError if suction leaves hardly any liquid.
  void book_liquid(const FlowProgress& flow);
  /// Flux per element at its centroid over the last interval, m/s; empty if no soil uses it.
  [[nodiscard]] std::vector<double> element_flux_magnitude() const {
    return acting_element_flux(grid_, *solid_, flux_history_, threads());
  }
  /// A row with the entries that do not depend on the transport.
  [[nodiscard]] HistoryRow common_history(const FlowState<Dim>& flow) const;
  /// Sets the row's entries on eroded and lost mass.
  void describe_losses(HistoryRow& row) const;
  /// Sets the row's entries on fines in the outflow; `fines_out`: their flux, m3/s.
  void describe_outflow(double fines_out, HistoryRow& row) const;
  /// The solid's masses: of the model, then of each region.
  [[nodiscard]] std::vector<StoredSums> solid_masses() const;

  const Case<Dim>& case_;
  ModelOptions options_;
  Grid<Dim> grid_;
  SoilMap<Dim> soils_;
  std::unique_ptr<const RankState> shared_state_;  ///< null: this program is alone
  SolidPhase<Dim> solid_phase_;
  Skeleton<Dim>* solid_;  ///< skeleton of `solid_phase_`
  // Made by each formulation.
  std::unique_ptr<FlowSolver<Dim>> flow_;
  std::unique_ptr<CoupledFlow<Dim>> coupled_;
  MassAccounts<Dim> masses_;
  Observations<Dim> observations_;
  double grain_density_;
  double time_ = 0.0;
  SolidExchange<Dim> exchange_;
  FluxHistory flux_history_;  ///< over the last interval

 private:
  double last_dt_ = 0.0;
  long steps_ = 0;
};

/// Makes the formulation of the scene. Keeps a reference to the case.
template <int Dim>
std::unique_ptr<TwoPhaseModel<Dim>> make_model(const Case<Dim>& c, const ModelOptions& options);

}  // namespace suffuse
