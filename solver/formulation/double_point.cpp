#include "formulation/double_point.hpp"

#include <algorithm>

#include "explicit/points_carrying_flow.hpp"
#include "formulation/smoothed_concentration.hpp"
#include "physics/head.hpp"
#include "points/points_along_faces.hpp"

namespace suffuse {

template <int Dim>
void DoublePoint<Dim>::advance(double latest) {
  const double start = this->time_;
  const PoreForecast<Dim> forecast = this->pore_forecast();
  // Flow (momentum, Eq. 4) and motion of the solid, together, over an interval that erosion and
  // transport allow. Points that carry the flow move with its steps. If the solid loses its
  // equilibrium, it gets inertia, or the run stops.
  CoupledStep<Dim> step =
      this->coupled_->solve({start, latest, this->coupling_interval(), forecast});
  const FlowProgress flow = this->coupled_->commit(std::move(step));
  this->start_exchange(start, flow);
  // Erosion (Eqs. 1, 6, 7), transport by points (Eq. 5), and deposition.
  const RegionCrossings& crossed =
      liquid_->move(start, flow, this->flow_->pressure(), this->exchange_);
  this->time_ = flow.end;
  // Masses that crossed borders with the flow and with the points.
  this->book_liquid(flow);
  this->masses_.book(crossed);
  update_flow(pores());
}

template <int Dim>
DoublePoint<Dim>::DoublePoint(const Case<Dim>& c, const ModelOptions& options)
    : TwoPhaseModel<Dim>(c, options),
      densities_{this->scene().liquid.density, this->grain_density_} {
  start_liquid();
  this->masses_.open(stored());
  update_flow(pores());
}

template <int Dim>
void DoublePoint<Dim>::start_liquid() {
  const Case<Dim>& c = this->case_;
  const FlowOptions& options = this->options_.flow;
  const double modulus = this->scene().liquid.bulk_modulus;
  const auto start_flow = [&] {
    update_flow(clean_pores());
    this->coupled_->start(this->options_.soil_start);
    this->start_flux_history();
  };
  // The explicit scheme exists only for triangles.
  if constexpr (Dim == 2) {
    if (this->scene().flow.integration == PressureIntegration::material_point) {
      auto flow = std::make_unique<ExplicitFlow<Dim>>(c, this->grid_, *this->solid_, options);
      ExplicitFlow<Dim>& carried = *flow;
      this->set_flow(std::move(flow));
      start_flow();
      liquid_ = std::make_unique<PointsCarryingFlow<Dim>>(
          this->grid_, *this->solid_, carried, injection_settings(c, this->grid_), densities_,
          modulus, this->threads(), c.liquid_points);
      return;
    }
  }
  this->set_flow(make_flow(c, this->grid_, *this->solid_, options));
  start_flow();
  liquid_ = std::make_unique<PointsAlongFaces<Dim>>(
      this->grid_, *this->solid_, this->flow_->conditions(), injection_settings(c, this->grid_),
      densities_, modulus, this->threads(), c.liquid_points, this->flow_->pressure());
}

template <int Dim>
void DoublePoint<Dim>::start_from(const EarlierState<Dim>& earlier) {
  this->start_solid(earlier);
  liquid_->start_from(earlier.liquid, earlier.flow.state);
  this->start_flow(earlier, [this] { update_flow(pores()); });
  this->masses_.open(stored());
}

template <int Dim>
EarlierState<Dim> DoublePoint<Dim>::last_state() const {
  return {.solid = this->solid_->state(),
          .moved = this->last_moved(),
          .flow = this->flow_->last_flow(this->time_),
          .liquid = liquid_->last_liquid()};
}

template <int Dim>
void DoublePoint<Dim>::archive(StateArchive& archive) {
  TwoPhaseModel<Dim>::archive(archive);
  archive(*liquid_, coefficients_timing_);
}

template <int Dim>
PoreState DoublePoint<Dim>::clean_pores() const {
  PoreState result;
  result.porosity = this->solid_->element_porosity();
  for (std::size_t e = 0; e < result.porosity.size(); ++e) {
    result.water_volume.push_back(result.porosity[e] * this->grid_.volume[e]);
  }
  result.concentration.assign(result.porosity.size(), 0.0);
  if (this->soils_.transfers_momentum()) result.flux = this->element_flux_magnitude();
  return result;
}

template <int Dim>
void DoublePoint<Dim>::find_liquid(PointFlows& flows) const {
  const ViscosityModel& viscosity = this->scene().liquid.viscosity_model;
  const double most = viscosity.depends_on_concentration() ? viscosity.maximum_concentration : 1.0;
  const std::vector<double> concentration = liquid_->concentration_ahead(most);
  const MaterialPoints<Dim>& points = this->soils_.points();
  flows.concentration.resize(points.size());
  flows.motion = LiquidMotion::passes;
  for (int p = 0; p < points.size(); ++p) {
    flows.concentration[p] = concentration[points.element[p]];
  }
}

template <int Dim>
PoreState DoublePoint<Dim>::pores() const {
  const LiquidContent content = liquid_->content();
  PoreState result = clean_pores();
  for (std::size_t e = 0; e < result.porosity.size(); ++e) {
    const double liquid = content.liquid[e];
    result.concentration[e] = liquid > 0.0 ? content.fines[e] / liquid : 0.0;
    result.water_volume[e] *= 1.0 - result.concentration[e];
  }
  if (has_gravity(this->scene().gravity) &&
      this->scene().time.scheme == FlowScheme::implicit_mixed) {
    result.concentration =
        smoothed_concentration(this->grid_, this->soils_, result.concentration, content.liquid);
  }
  return result;
}

template <int Dim>
void DoublePoint<Dim>::update_flow(const PoreState& pores) {
  const PassTimer timer(coefficients_timing_);
  ++coefficients_timing_.calls;
  // Points carry the fines, so the concentration at faces is not used.
  this->flow_->update(this->time_, pores, std::vector<double>(this->grid_.face_count(), 0.0));
}

template <int Dim>
std::vector<PassTiming> DoublePoint<Dim>::passes() const {
  std::vector<PassTiming> result = this->coupled_->passes();
  result.push_back(this->exchange_.timing());
  for (PassTiming& timing : liquid_->passes()) result.push_back(std::move(timing));
  result.push_back(coefficients_timing_);
  return result;
}

template class DoublePoint<2>;
template class DoublePoint<3>;

}  // namespace suffuse
