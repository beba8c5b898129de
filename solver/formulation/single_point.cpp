#include "formulation/single_point.hpp"

#include <algorithm>
#include <limits>

#include "formulation/element_snapshot.hpp"
#include "grid/parallel.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

FieldTransportSettings field_settings(const Scene& scene, const ModelOptions& options) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const bool is_explicit = scene.time.scheme == FlowScheme::explicit_nodal;
  return {is_explicit ? TransportScheme::explicit_steps : scene.time.transport,
          options.transport ? options.fines_from : never,
          {scene.time.end, scene.time.tolerance, scene.time.step.has_value()},
          scene.moves()};
}

}  // namespace

template <int Dim>
void SinglePoint<Dim>::advance(double latest) {
  const double start = this->time_;
  const PoreForecast<Dim> forecast = this->pore_forecast();
  // Flow (momentum, Eq. 2) and motion of the solid, together, over an interval that erosion and
  // transport allow. If the solid loses its equilibrium, it gets inertia, or the run stops.
  CoupledStep<Dim> step =
      this->coupled_->solve({start, latest, this->coupling_interval(), forecast});
  const FlowProgress flow = this->coupled_->commit(std::move(step));
  this->start_exchange(start, flow);
  // Erosion (Eqs. 1, 6, 7), deposition, and transport (Eq. 3), with the volumes that crossed faces.
  std::vector<double> fines = fines_->move(start, flow, this->exchange_);
  this->time_ = flow.end;
  // Masses, and the pressures that follow from them.
  this->book_liquid(flow);
  book(flow.volumes, std::move(fines));
  update_flow();
  match_masses();
}

template <int Dim>
SinglePoint<Dim>::SinglePoint(const Case<Dim>& c, const ModelOptions& options)
    : TwoPhaseModel<Dim>(c, options) {
  this->set_flow(make_flow(c, this->grid_, *this->solid_, options.flow));
  fines_ = std::make_unique<FieldTransport<Dim>>(
      this->grid_, this->soils_, this->flow_->conditions(), this->flow_->boundary_values(),
      field_settings(this->scene(), options), options.flow.threads);
  update_flow();
  this->coupled_->start(options.soil_start);
  if (const std::vector<double> air = this->flow_->air(); !air.empty()) {
    fines_->start(air);
    update_flow();
  }
  this->start_flux_history();
  water_mass_.resize(this->grid_.mesh.element_count());
  follow_pressure();
  this->masses_.open(stored());
}

template <int Dim>
void SinglePoint<Dim>::start_from(const EarlierState<Dim>& earlier) {
  EarlierState<Dim> state = earlier;
  const std::vector<int> changed = this->start_solid(earlier);
  fill_pores(
      this->grid_, flow_soils(this->scene(), *this->solid_), this->scene().liquid,
      this->solid_->element_porosity(), earlier.flow, changed,
      {state.fines.liquid_volume, state.fines.fines_volume, state.flow.air, state.water_mass});
  fines_->start_from(state.fines);
  this->start_flow(state, [this, &state] {
    this->flow_->update(this->time_, pores_with(state.flow.air_volume()), face_concentration());
  });
  water_mass_ = std::move(state.water_mass);
  match_masses();
  this->masses_.open(stored());
}

template <int Dim>
EarlierState<Dim> SinglePoint<Dim>::last_state() const {
  return {.solid = this->solid_->state(),
          .moved = this->last_moved(),
          .flow = this->flow_->last_flow(this->time_),
          .fines = fines_->state(),
          .water_mass = water_mass_};
}

template <int Dim>
void SinglePoint<Dim>::archive(StateArchive& archive) {
  TwoPhaseModel<Dim>::archive(archive);
  archive(*fines_, on_elements(water_mass_), water_timing_);
}

template <int Dim>
PoreState SinglePoint<Dim>::pores() const {
  return pores_with(this->flow_->air());
}

template <int Dim>
PoreState SinglePoint<Dim>::pores_with(std::vector<double> air_volume) const {
  const FinesState<Dim>& state = fines_->state();
  const int elements = this->grid_.mesh.element_count();
  PoreState result;
  result.air_volume = std::move(air_volume);
  const std::vector<double>& air = result.air_volume;
  result.porosity.resize(elements);
  result.water_volume.resize(elements);
  result.concentration.resize(elements);
  for_each_index(elements, this->threads(), [&](int e) {
    const double liquid = element_sum<Dim>(state.liquid_volume[e]);
    const double fines = element_sum<Dim>(state.fines_volume[e]);
    const double pores = air.empty() ? liquid : liquid + air[e];
    result.porosity[e] = pores / this->grid_.volume[e];
    result.water_volume[e] = liquid - fines;
    result.concentration[e] = liquid > 0.0 ? fines / liquid : 0.0;
  });
  if (this->soils_.transfers_momentum()) result.flux = this->element_flux_magnitude();
  return result;
}

template <int Dim>
void SinglePoint<Dim>::find_liquid(PointFlows& flows) const {
  const FinesState<Dim>& state = fines_->state();
  const MaterialPoints<Dim>& points = this->soils_.points();
  const std::vector<double> air = this->flow_->air();
  const bool flows_on = fines_->is_implicit(this->flux_history_.mean);
  flows.motion = flows_on ? LiquidMotion::flows_on : LiquidMotion::stays;
  flows.concentration.resize(points.size());
  if (!air.empty()) flows.saturation.resize(air.size());
  for_each_index(this->grid_.mesh.element_count(), this->threads(), [&](int e) {
    const double liquid = element_sum<Dim>(state.liquid_volume[e]);
    const double saturation = air.empty() ? 1.0 : liquid / (liquid + air[e]);
    if (!air.empty()) flows.saturation[e] = saturation;
    ElementValues<Dim> at_nodes;
    for (int j = 0; j <= Dim; ++j) at_nodes[j] = state.concentration(e, j);
    double held = 0.0;
    for (int p = this->soils_.points_begin(e); p < this->soils_.points_begin(e + 1); ++p) {
      const double c = std::max(0.0, FieldNodes<Dim>::value(at_nodes, points.barycentric[p]));
      flows.concentration[p] = c;
      held += points.volume[p] * this->solid_->porosity()[p] * saturation * c;
    }
    // The points of an element hold exactly its fines, so that deposits cannot exceed them.
    const double scale = held > 0.0 ? element_sum<Dim>(state.fines_volume[e]) / held : 0.0;
    for (int p = this->soils_.points_begin(e); p < this->soils_.points_begin(e + 1); ++p) {
      flows.concentration[p] *= scale;
    }
  });
}

template <int Dim>
void SinglePoint<Dim>::update_flow() {
  const PassTimer timer(water_timing_);
  this->flow_->update(this->time_, pores(), face_concentration());
}

template <int Dim>
void SinglePoint<Dim>::book(const FaceVolumes& volumes, std::vector<double> fines) {
  const PassTimer timer(water_timing_);
  ++water_timing_.calls;
  const Grid<Dim>& grid = this->grid_;
  const bool conservative = this->scene().flow.porosity_gradient_term;
  const double density = this->scene().liquid.density;
  const FlowCoefficients<Dim>& coefficients = this->flow_->coefficients();
  std::vector<double> water(grid.face_count());
  for_each_index(grid.face_count(), this->threads(), [&](int f) {
    const double excess = (1.0 - coefficients.face_concentration[f]) * volumes.density_excess[f];
    water[f] = density * ((volumes.liquid[f] - fines[f]) + excess);
    fines[f] *= this->grain_density_;
    if (!conservative) water[f] *= coefficients.porosity[grid.face_left[f]];
  });
  this->masses_.book(water, fines);
  if (!conservative) return;
  for_each_index(grid.mesh.element_count(), this->threads(), [&](int e) {
    for (int k = 0; k <= Dim; ++k) {
      water_mass_[e] -= grid.element_face_sign[e][k] * water[grid.element_face[e][k]];
    }
  });
}

template <int Dim>
void SinglePoint<Dim>::follow_pressure() {
  const LiquidProperties& liquid = this->scene().liquid;
  for (std::size_t e = 0; e < water_mass_.size(); ++e) {
    water_mass_[e] = liquid.density * this->flow_->coefficients().water_volume[e] *
                     density_ratio(this->flow_->pressure()[e], liquid.bulk_modulus);
  }
}

template <int Dim>
void SinglePoint<Dim>::match_masses() {
  const PassTimer timer(water_timing_);
  if (this->scene().flow.porosity_gradient_term) {
    // Masses are conserved, and the pressure follows from them.
    this->flow_->match_masses(this->time_, water_mass_);
  } else {
    // Without the third term of Eq. 2 only the strain is integrated, and the masses follow.
    follow_pressure();
  }
}

template <int Dim>
HistoryRow SinglePoint<Dim>::history_row(const FlowState<Dim>& flow) const {
  HistoryRow row = this->common_history(flow);
  const std::vector<double> concentration =
      fines_->face_concentration(std::numeric_limits<double>::infinity(), flow.face_flux);
  ExactSum fines_out;
  for (const int f : this->grid_.own_faces()) {
    const double flux = flow.face_flux[f];
    if (this->grid_.is_border(f) && flux > 0.0) fines_out.add(flux * concentration[f]);
  }
  this->grid_.ranks().sum({&fines_out});
  this->describe_outflow(fines_out.value(), row);

  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  int at = 0;
  const FinesState<Dim>& state = fines_->state();
  for (const int e : this->grid_.own_elements()) {
    for (int j = 0; j <= Dim; ++j) {
      const double c = state.concentration(e, j);
      least = std::min(least, c);
      if (!(c > most)) continue;
      most = c;
      at = e;
    }
  }
  row.concentration_min = smallest_of_all(this->grid_.ranks(), least);
  const auto [highest, place] = largest_of_all(this->grid_, most, at);
  row.concentration_max = highest;
  row.concentration_max_at = place;
  return row;
}

template <int Dim>
std::vector<Stored> SinglePoint<Dim>::stored() const {
  std::vector<StoredSums> sums = this->solid_masses();
  const FinesState<Dim>& state = fines_->state();
  for (const int e : this->grid_.own_elements()) {
    StoredSums& sum = sums[this->grid_.mesh.element_region[e] + 1];
    sum.water.add(water_mass_[e]);
    sum.fines.add(this->grain_density_ * element_sum<Dim>(state.fines_volume[e]));
  }
  return totals(this->grid_.ranks(), std::move(sums));
}

template <int Dim>
Snapshot SinglePoint<Dim>::snapshot(const FlowState<Dim>& flow) const {
  return element_snapshot(this->grid_, *this->solid_, fines_->state(), flow, this->scene(),
                          this->steps());
}

template <int Dim>
std::vector<PassTiming> SinglePoint<Dim>::passes() const {
  std::vector<PassTiming> result = this->coupled_->passes();
  result.push_back(this->exchange_.timing());
  for (const PassTiming& timing : fines_->passes()) result.push_back(timing);
  result.push_back(water_timing_);
  return result;
}

template class SinglePoint<2>;
template class SinglePoint<3>;

}  // namespace suffuse
