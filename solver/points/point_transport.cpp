#include "points/point_transport.hpp"

#include <algorithm>
#include <sstream>

#include "common/errors.hpp"

namespace suffuse {

template <int Dim>
PointTransport<Dim>::PointTransport(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                                    const std::vector<FaceCondition>& conditions,
                                    InjectionSettings injection, LiquidDensities densities,
                                    double bulk_modulus, int threads)
    : grid_(grid),
      solid_(solid),
      densities_(densities),
      bulk_modulus_(bulk_modulus),
      threads_(threads),
      shared_(grid),
      injection_(grid, conditions, std::move(injection), densities, bulk_modulus),
      transfer_(grid, solid.soils(), shared_, densities.grain),
      deposition_(grid, solid, shared_, densities.grain),
      pending_(grid.mesh.node_count(), 0.0) {}

template <int Dim>
const RegionCrossings& PointTransport<Dim>::move(double start, const FlowProgress& flow,
                                                 const std::vector<double>& pressure,
                                                 SolidExchange<Dim>& exchange,
                                                 std::optional<double> steps) {
  start_interval(flow);
  if (!steps) steps = steps_needed(start, flow);
  for (const TransportStep& step : equal_steps(start, flow.end, *steps)) {
    const std::vector<double>& eroded = exchange.over({step.start, step.end}, dry_elements());
    if (exchange.depends_on_concentration()) concentration_before_ = element_concentration();
    advance(step, flow.volumes, eroded, pressure);
    if (!deposition_.active()) continue;
    exchange.deposit(deposition_.deposited());
    follow_deposits();
  }
  std::vector<ExactSum*> sums;
  for (ExactSum& sum : given_) sums.push_back(&sum);
  for (ExactSum& sum : received_) sums.push_back(&sum);
  grid_.ranks().sum(sums);
  for (std::size_t r = 0; r < given_.size(); ++r) {
    crossings_.fines_out.push_back(given_[r].minus(received_[r]));
  }
  return crossings_;
}

template <int Dim>
std::vector<double> PointTransport<Dim>::element_concentration() const {
  const LiquidContent content = this->content();
  std::vector<double> result(content.liquid.size());
  for (std::size_t e = 0; e < result.size(); ++e) {
    result[e] = content.liquid[e] > 0.0 ? content.fines[e] / content.liquid[e] : 0.0;
  }
  return result;
}

template <int Dim>
std::vector<double> PointTransport<Dim>::concentration_ahead(double most) const {
  std::vector<double> concentration = element_concentration();
  for (std::size_t e = 0; e < concentration_before_.size(); ++e) {
    const double now = concentration[e];
    const double ahead = now + 0.5 * (now - concentration_before_[e]);
    concentration[e] = std::clamp(ahead, 0.0, std::max(now, 0.5 * (now + most)));
  }
  return concentration;
}

template <int Dim>
std::vector<char> PointTransport<Dim>::dry_elements() const {
  std::vector<char> result;
  const SoilMap<Dim>& soils = solid_.soils();
  for (const int e : grid_.own_elements()) {
    if (soils.soil_of_element(e).erosion.empty_elements != EmptyElements::dry || has_points(e)) {
      continue;
    }
    result.resize(grid_.mesh.elements.size(), 0);
    result[e] = 1;
  }
  if (!any_of_all(grid_.ranks(), !result.empty())) return {};
  result.resize(grid_.mesh.elements.size(), 0);
  grid_.element_rows().exchange(result);
  return result;
}

template <int Dim>
bool PointTransport<Dim>::has_pending() const {
  const bool here = std::ranges::any_of(pending_, [](double volume) { return volume != 0.0; });
  return any_of_all(grid_.ranks(), here);
}

template <int Dim>
double PointTransport<Dim>::empty_elements() const {
  double empty = 0.0;
  for (const int e : grid_.own_elements()) {
    if (solid_.soils().is_soil(e) && !has_points(e)) ++empty;
  }
  return sum_of_all(grid_.ranks(), empty);
}

template <int Dim>
void PointTransport<Dim>::start_crossings() {
  crossings_.points.clear();
  crossings_.fines_out.clear();
  given_.assign(grid_.mesh.region_names.size(), {});
  received_ = given_;
}

template <int Dim>
void PointTransport<Dim>::book(const typename FinesTransfer<Dim>::Result& transferred) {
  for (std::size_t r = 0; r < given_.size(); ++r) {
    given_[r].add(transferred.eroded[r]);
    received_[r].add(transferred.received[r]);
  }
}

template <int Dim>
void PointTransport<Dim>::book_deposition() {
  for (std::size_t r = 0; r < given_.size(); ++r) {
    given_[r].add(deposition_.lost_by_region()[r]);
    received_[r].add(deposition_.by_region()[r]);
  }
}

template class PointTransport<2>;
template class PointTransport<3>;

}  // namespace suffuse
