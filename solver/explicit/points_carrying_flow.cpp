#include "explicit/points_carrying_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grid/face_flux.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Share of an element that a point may cross between two couplings with erosion.
constexpr double max_share_of_element = 0.25;

}  // namespace

template <int Dim>
PointsCarryingFlow<Dim>::PointsCarryingFlow(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                                            ExplicitFlow<Dim>& flow, InjectionSettings injection,
                                            LiquidDensities densities, double bulk_modulus,
                                            int threads, const MaterialPoints<Dim>& places)
    : PointTransport<Dim>(grid, solid, flow.conditions(), std::move(injection), densities,
                          bulk_modulus, threads),
      flow_(flow),
      points_(grid, densities, threads),
      entered_(grid.face_count(), 0.0) {
  this->inflow_ = this->injection_.initial_account(places.size());
  fill(clean_liquid(places, flow.pressure(), densities, bulk_modulus), flow.pressure(),
       flow.scheme().velocity());
  flow.set_carrier(*this);
}

template <int Dim>
void PointsCarryingFlow<Dim>::fill(LiquidPoints<Dim> points, const std::vector<double>& pressure,
                                   const VectorField<Dim>& velocity) {
  if (points.pressure.empty()) {
    for (int p = 0; p < points.size(); ++p) {
      points.pressure.push_back(pressure[points.element[p]]);
      points.velocity.push_back(interpolate(this->grid_, points.place(p), velocity));
    }
  }
  points_.blocks().fill(points, this->grid_.mesh.element_count());
  output_points_ = {};
}

template <int Dim>
void PointsCarryingFlow<Dim>::take_points(LiquidPoints<Dim> points, const FlowState<Dim>& flow) {
  fill(std::move(points), flow.pressure, flow.velocity);
}

template <int Dim>
void PointsCarryingFlow<Dim>::archive(StateArchive& archive) {
  PointTransport<Dim>::archive(archive);
  archive(points_.blocks(), exchange_timing_);
  output_points_ = {};
}

template <int Dim>
void PointsCarryingFlow<Dim>::before_steps(const std::vector<double>& porosity) {
  this->start_crossings();
  output_points_ = {};
  porosity_ = porosity;
}

template <int Dim>
void PointsCarryingFlow<Dim>::before_step() {
  const PassTimer timer(exchange_timing_);
  ++exchange_timing_.calls;
  flow_.scheme().rewrite([this](VectorField<Dim>& velocity, std::vector<double>& pressure) {
    points_.points_to_grid(velocity, pressure);
    pressure_before_ = pressure;
  });
}

template <int Dim>
void PointsCarryingFlow<Dim>::after_step(double dt) {
  const PassTimer timer(this->movement_timing_);
  ++this->movement_timing_.calls;
  flow_.node_flux(node_flux_);
  for (const int f : this->injection_.open_faces()) entered_[f] = dt * flow_.flux_through(f);
  inject(dt);
  const auto& scheme = flow_.scheme();
  moved_.clear();
  points_.grid_to_points(
      {scheme.previous_velocity(), scheme.velocity(), pressure_before_, scheme.pressure()},
      {node_flux_, porosity_, this->injection_.is_open()}, dt, arriving_, moved_);
  for (const PointCrossing& point : moved_) {
    this->crossings_.points.push_back(point);
    if (point.left_by < 0) continue;
    this->inflow_.volume[point.left_by] +=
        liquid_volume(point.water_mass, point.fines_mass, this->densities_, 1.0);
  }
  this->empty_total_ += this->empty_elements();
}

template <int Dim>
void PointsCarryingFlow<Dim>::inject(double dt) {
  const auto& scheme = flow_.scheme();
  injected_.clear();
  arriving_.clear();
  this->injection_.inject(this->inflow_, entered_, node_flux_, injected_);
  for (const InjectedPoint<Dim>& injected : injected_) {
    const double pressure = scheme.pressure()[injected.place.element];
    const auto [water_mass, fines_mass] = this->injection_.content(injected, pressure);
    CarriedPoint<Dim> point{};
    std::copy_n(injected.place.barycentric.begin(), Dim, point.at.begin());
    point.velocity = interpolate(this->grid_, injected.place, scheme.velocity());
    point.pressure = pressure;
    point.water_mass = water_mass;
    point.fines_mass = fines_mass;
    point.id = this->inflow_.next_id++;
    arriving_.push_back({injected.place, point, (1.0 - injected.share) * dt, injected.face});
  }
}

template <int Dim>
double PointsCarryingFlow<Dim>::longest_step(const std::vector<double>& /*face_rate*/) const {
  VectorField<Dim> node_flux;
  flow_.node_flux(node_flux);
  const std::vector<double>& porosity = flow_.coefficients().porosity;
  const WalkField<Dim> field{node_flux, porosity, this->injection_.is_open()};
  double fastest = 0.0;
  for (int e = 0; e < this->grid_.mesh.element_count(); ++e) {
    fastest = std::max(fastest, crossing_rate(this->grid_, field, e));
  }
  return fastest > 0.0 ? transport_safety * max_share_of_element / fastest
                       : std::numeric_limits<double>::infinity();
}

template <int Dim>
void PointsCarryingFlow<Dim>::advance(const TransportStep& step, const FaceVolumes& volumes,
                                      const std::vector<double>& eroded,
                                      const std::vector<double>& /*pressure*/) {
  const bool catches = this->deposition_.active();
  if (eroded.empty() && !this->has_pending() && !catches) return;
  output_points_ = {};
  const PassTimer timer(this->fines_timing_);
  ++this->fines_timing_.calls;
  this->book(this->transfer_.transfer(eroded, porosity_, this->densities_, points_.blocks(),
                                      this->pending_));
  if (!catches) return;
  this->deposition_.start(step.end - step.start);
  this->deposition_.leave_in_elements(element_flux(this->grid_, volumes.liquid), porosity_,
                                      points_.blocks());
  this->book_deposition();
}

template <int Dim>
LiquidContent PointsCarryingFlow<Dim>::content() const {
  const PointBlocks<Dim>& points = points_.blocks();
  const int elements = this->grid_.mesh.element_count();
  LiquidContent content{std::vector<double>(elements, 0.0), std::vector<double>(elements, 0.0)};
  for (int e = 0; e < elements; ++e) {
    for (int slot = 0; slot < points.count(e); ++slot) {
      const double fines_mass = points.fines_mass(e, slot);
      content.fines[e] += fines_mass / this->densities_.grain;
      content.liquid[e] +=
          liquid_volume(points.water_mass(e, slot), fines_mass, this->densities_, 1.0);
    }
  }
  return content;
}

template <int Dim>
std::vector<double> PointsCarryingFlow<Dim>::point_pressure(const LiquidPoints<Dim>& points,
                                                            const FlowState<Dim>& /*flow*/) const {
  return points.pressure;
}

template <int Dim>
std::vector<double> PointsCarryingFlow<Dim>::point_volume(
    const LiquidPoints<Dim>& points, const std::vector<double>& /*pressure*/) const {
  std::vector<double> result(points.size());
  for (int p = 0; p < points.size(); ++p) {
    result[p] = liquid_volume(points.water_mass[p], points.fines_mass[p], this->densities_,
                              density_ratio(points.pressure[p], this->bulk_modulus_));
  }
  return result;
}

template <int Dim>
void PointsCarryingFlow<Dim>::describe(const FlowState<Dim>& flow, HistoryRow& row) const {
  // Deviation of the points' pressures from the smooth field of the nodes.
  const LiquidPoints<Dim>& points = this->points();
  const std::vector<double> volume = point_volume(points, flow.pressure);
  double square = 0.0;
  double sum = 0.0;
  for (int p = 0; p < points.size(); ++p) {
    const double off =
        points.pressure[p] - interpolate(this->grid_, points.place(p), flow.node_pressure);
    square += volume[p] * off * off;
    sum += volume[p];
  }
  row.pressure_scatter = std::sqrt(square / sum);
}

template class PointsCarryingFlow<2>;

}  // namespace suffuse
