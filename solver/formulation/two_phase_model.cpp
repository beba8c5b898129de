#include "formulation/two_phase_model.hpp"

#include <algorithm>
#include <limits>

#include "boundary/leaky_walls.hpp"
#include "formulation/seepage_measures.hpp"
#include "grid/face_flux.hpp"

namespace suffuse {
template <int Dim>
TwoPhaseModel<Dim>::TwoPhaseModel(const Case<Dim>& c, const ModelOptions& options)
    : case_(c),
      options_(options),
      grid_(grid_with_walls(c, options.part.get())),
      soils_(c),
      shared_state_(options.part ? std::make_unique<const RankState>(grid_, soils_) : nullptr),
      solid_phase_(make_skeleton(grid_, soils_,
                                 options.erosion ? options.erosion_span : TimeSpan::never(),
                                 options.flow.threads)),
      solid_(solid_phase_.skeleton.get()),
      masses_(c, grid_),
      observations_(c, grid_),
      grain_density_(c.document.scene.soils.front().grain_density),
      exchange_(*solid_, [this](PointFlows& flows) { find_liquid(flows); }) {
  flux_history_.mean.assign(grid_.face_count(), 0.0);
  flux_history_.end = flux_history_.mean;
}

template <int Dim>
void TwoPhaseModel<Dim>::archive(StateArchive& archive) {
  archive(*solid_, *flow_, *coupled_, masses_, observations_, time_, on_faces(flux_history_.mean),
          on_faces(flux_history_.end), flux_history_.duration, last_dt_, steps_, exchange_);
}

template <int Dim>
double TwoPhaseModel<Dim>::coupling_interval() const {
  const auto limits = flow_->coupling_limits();
  double longest = flow_->longest_of_boundaries(time_);
  if (options_.transport) {
    const double steps = limits.one_transport_step ? 1.0 : transport().coupling().steps;
    longest = std::min(longest, steps * transport().longest_step(flux_history_.mean));
  }
  const bool changes = solid_->exchanges_within(time_, std::numeric_limits<double>::infinity());
  if (limits.follows_pores || !changes) return longest;
  const double growth = transport().coupling().pore_growth;
  const std::vector<double>& porosity = flow_->coefficients().porosity;
  const std::vector<double> fluxes = element_flux_magnitude();
  const std::vector<double> concentration =
      soils_.exchange_depends_on().concentration ? pores().concentration : std::vector<double>();
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const ExchangeModel& model = soils_.exchange_of_element(e);
    if (!model.exchanges()) continue;
    const double flux = fluxes.empty() ? unset : fluxes[e];
    const double c = concentration.empty() ? unset : concentration[e];
    const SoilPlace place{
        soils_.soil_of_element(e).initial_porosity(element_centroid(grid_.mesh, e)), porosity[e],
        soils_.conductivity_factor(e)};
    const Exchange rate =
        exchange_rate(model, place, {.flux_start = flux, .flux_end = flux, .concentration = c},
                      std::max(time_, model.erosion.start));
    const double fastest = std::max(rate.eroded, rate.deposited);
    if (fastest > 0.0) longest = std::min(longest, growth * porosity[e] / fastest);
  }
  return smallest_of_all(grid_.ranks(), longest);
}

template <int Dim>
PoreForecast<Dim> TwoPhaseModel<Dim>::pore_forecast() {
  const PointFlows& flows = exchange_.find_flows();
  return {grid_, *solid_, time_, pores(), flows, flux_history_, threads()};
}

template <int Dim>
void TwoPhaseModel<Dim>::set_flow(std::unique_ptr<FlowSolver<Dim>> flow) {
  flow_ = std::move(flow);
  coupled_ =
      std::make_unique<CoupledFlow<Dim>>(scene(), grid_, *flow_, solid_phase_.moving, threads());
}

template <int Dim>
std::vector<int> TwoPhaseModel<Dim>::start_solid(const EarlierState<Dim>& earlier) {
  if (!earlier.moved) {
    solid_->start_from(earlier.solid);
    return {};
  }
  MovingSkeleton<Dim>& moving = *solid_phase_.moving;
  NextStage<Dim> stage = next_stage(scene(), grid_.mesh, moving.moved(), *earlier.moved);
  moving.start_from(std::move(stage.soil));
  return stage.changed;
}

template <int Dim>
void TwoPhaseModel<Dim>::start_flux_history() {
  flux_history_.mean = flux_history_.end = flow_->face_flux(0.0);
  flow_->check_suction(0.0);
}

template <int Dim>
void TwoPhaseModel<Dim>::start_exchange(double start, const FlowProgress& flow) {
  flux_history_.duration = flow.end - start;
  flux_history_.mean = per_time(flow.relative_volumes(), flux_history_.duration);
  flux_history_.end =
      soils_.exchange_depends_on().flux ? flow_->face_flux(flow.end) : flux_history_.mean;
  PointFlows flows =
      point_flows(grid_, soils_, flux_history_.mean, flux_history_.duration, threads());
  flows.start = start;
  flows.end = flow.end;
  flows.take_liquid(exchange_.flows());
  find_flux_change(grid_, soils_, flux_history_, flows, threads());
  solid_->find_eroding_flux(flows);
  exchange_.start_interval(std::move(flows));
}

template <int Dim>
void TwoPhaseModel<Dim>::book_liquid(const FlowProgress& flow) {
  flow_->check_suction(flow.end);
  masses_.book_liquid(flow.volumes.liquid);
  observations_.book_liquid(flow.volumes.liquid);
  steps_ += flow.steps;
  last_dt_ = flow.dt;
}

template <int Dim>
std::vector<RegionRow> TwoPhaseModel<Dim>::region_rows() const {
  return masses_.region_rows(time_, stored(), soils_, grain_density_);
}

namespace {

/// Enters an interval into a row: as bounds, or as what is estimated.
void enter(const DischargeBounds& bounds, const Interval& interval, double& low, double& high,
           double& estimate) {
  if (!bounds.why_estimates.empty()) {
    estimate = interval.half();
    return;
  }
  low = interval.low;
  high = interval.high;
}

}  // namespace

template <int Dim>
FlowState<Dim> TwoPhaseModel<Dim>::flow_state() const {
  FlowState<Dim> flow = flow_->state(time_);
  if (!scene().mesh.error) return flow;
  try {
    flow.bounds = flow_->discharge_bounds();
  } catch (const NumericalError&) {
    // A dual flow without a solution bounds nothing, and is no reason to end the run.
  }
  return flow;
}

template <int Dim>
std::vector<BoundaryRow> TwoPhaseModel<Dim>::boundary_rows(const FlowState<Dim>& flow) const {
  std::vector<BoundaryRow> rows = masses_.boundaries().rows(time_, flow.face_flux);
  const std::vector<BoundaryCondition>& boundaries = soils_.scene().boundaries;
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    BoundaryRow& row = rows[b];
    if (boundaries[b].head) {
      row.level = flow_->boundary_values().level(static_cast<int>(b), time_);
    }
    if (!flow.bounds) continue;
    row.discharge_time_estimate = flow.bounds->boundary_steps[b].time;
    row.discharge_transport_estimate = flow.bounds->boundary_steps[b].transport;
    if (!flow.bounds->boundaries[b]) continue;
    enter(*flow.bounds, *flow.bounds->boundaries[b], row.discharge_low, row.discharge_high,
          row.discharge_estimate);
  }
  return rows;
}

template <int Dim>
std::vector<ProbeRow> TwoPhaseModel<Dim>::probe_rows(const FlowState<Dim>& flow) const {
  if (!observations_.has_probes()) return {};
  return observations_.probe_rows(flow, fines_state(flow));
}

template <int Dim>
std::vector<SectionRow> TwoPhaseModel<Dim>::section_rows(const FlowState<Dim>& flow) const {
  return observations_.section_rows(flow);
}

template <int Dim>
HistoryRow TwoPhaseModel<Dim>::common_history(const FlowState<Dim>& flow) const {
  HistoryRow row;
  row.t = time_;
  describe_flow(grid_, flow_->coefficients(), flow, scene(), row);
  // Mean over soils that exchange fines, or over all soils if none does.
  const MaterialPoints<Dim>& points = soils_.points();
  const bool any_changes = soils_.erodes() || soils_.deposits();
  ExactSum pores;
  ExactSum volume;
  for (const int p : soils_.points_of(grid_.own_elements())) {
    if (any_changes && !soils_.exchange_of_point(p).exchanges()) continue;
    pores.add(points.volume[p] * solid_->porosity()[p]);
    volume.add(points.volume[p]);
  }
  grid_.ranks().sum({&pores, &volume});
  row.porosity_mean = pores.value() / volume.value();
  describe_losses(row);
  const SeepagePower power =
      seepage_power(grid_, soils_, flow_->coefficients().mixture_density, flow, scene());
  row.power = power.now;
  row.conductivity_ratio = power.conductivity_ratio();
  solid_->describe(row);
  coupled_->describe(row);
  if (flow.bounds) {
    row.flux_out_time_estimate = flow.bounds->flux_out_step.time;
    row.flux_out_transport_estimate = flow.bounds->flux_out_step.transport;
    if (flow.bounds->flux_out) {
      enter(*flow.bounds, *flow.bounds->flux_out, row.flux_out_low, row.flux_out_high,
            row.flux_out_estimate);
    }
  }
  return row;
}

template <int Dim>
void TwoPhaseModel<Dim>::describe_losses(HistoryRow& row) const {
  const LedgerRow masses = ledger();
  row.eroded = masses.eroded;
  row.fines_out = masses.fines_out;
  double fines = masses_.initial(0).fines;
  for (std::size_t r = 0; r + 1 < masses_.count(); ++r) {
    const Soil* soil = scene().find_soil(grid_.mesh.region_names[r]);
    if (soil && erodes(soil->erosion_model())) fines += masses_.initial(r + 1).erodible;
  }
  if (fines > 0.0) row.fines_out_percent = 100.0 * masses.fines_out / fines;
  row.solid_out_percent = 100.0 * masses.fines_out / masses_.initial(0).solid;
}

template <int Dim>
void TwoPhaseModel<Dim>::describe_outflow(double fines_out, HistoryRow& row) const {
  row.concentration_out = row.flux_out > 0.0 ? fines_out / row.flux_out : 0.0;
  row.turbidity_out = grain_density_ * row.concentration_out;  // kg/m3 = g/l
}

template <int Dim>
std::vector<StoredSums> TwoPhaseModel<Dim>::solid_masses() const {
  std::vector<StoredSums> sums(masses_.count());
  const MaterialPoints<Dim>& points = soils_.points();
  const SolidState& solid = solid_->state();
  for (const int e : grid_.own_elements()) {
    // Exact sums cost several times as much as plain ones, which do within an element.
    Stored here;
    for (int p = soils_.points_begin(e); p < soils_.points_begin(e + 1); ++p) {
      here.solid += solid.solid_volume(p);
      here.erodible += solid.erodible_volume[p];
      const double deposited = solid.deposited_volume.empty() ? 0.0 : solid.deposited_volume[p];
      here.deposited += deposited;
      if (!erodes(soils_.exchange_of_point(p).erosion)) continue;
      here.eroded += points.volume[p] * solid_->eroded_share(p) + deposited;
    }
    StoredSums& sum = sums[grid_.mesh.element_region[e] + 1];
    sum.solid.add(grain_density_ * here.solid);
    sum.erodible.add(grain_density_ * here.erodible);
    sum.deposited.add(grain_density_ * here.deposited);
    sum.eroded.add(grain_density_ * here.eroded);
  }
  const std::vector<double> carried = solid_->region_gain();
  for (std::size_t r = 0; r < carried.size(); ++r) {
    sums[r + 1].carried.add(grain_density_ * carried[r]);
  }
  return sums;
}

template class TwoPhaseModel<2>;
template class TwoPhaseModel<3>;

}  // namespace suffuse
