#include "solid/point_flows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "grid/face_flux.hpp"
#include "grid/parallel.hpp"

namespace suffuse {

PlaceFlow PointFlows::at(int point, int element, double from, double to) const {
  PlaceFlow flow;
  std::tie(flow.flux_start, flow.flux_end) = flux_ends(point, from, to);
  if (!eroding_flux.empty()) flow.deposition_flux = flux[point];
  if (!resistance.empty()) flow.resistance = resistance[point];
  if (!concentration.empty()) flow.concentration = concentration[point];
  if (!saturation.empty()) flow.saturation = saturation[element];
  flow.motion = motion;
  return flow;
}

template <int Dim>
double acting_flux(const Grid<Dim>& grid, const SoilMap<Dim>& soils, int element, double flux,
                   double duration) {
  constexpr double round_off = 4.0 * std::numeric_limits<double>::epsilon();
  const double held = std::pow(grid.volume[element], 1.0 / Dim);
  const bool acts = flux > round_off * held / duration && flux > soils.still_flux(element);
  return acts ? flux : 0.0;
}

template <int Dim>
PointFlows point_flows(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                       const std::vector<double>& face_rate, double duration, int threads) {
  PointFlows result;
  const auto& needed = soils.exchange_depends_on();
  if (!needed.flux) return result;
  const MaterialPoints<Dim>& points = soils.points();
  result.flux.resize(points.size());
  if (needed.resistance) result.resistance.resize(points.size());
  for_each_index(points.size(), threads, [&](int p) {
    const int e = points.element[p];
    const Vector<Dim> flux = flux_at(grid, face_rate, e, points.position(grid.mesh, p));
    const double size = flux.norm();
    result.flux[p] = acting_flux(grid, soils, e, size, duration);
    if (!needed.resistance) return;
    result.resistance[p] = soils.resistance_along(e, flux);
  });
  return result;
}

template <int Dim>
void find_flux_change(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const FluxHistory& history,
                      PointFlows& flows, int threads) {
  if (!soils.exchange_depends_on().flux_change) return;
  const MaterialPoints<Dim>& points = soils.points();
  flows.flux_change.resize(points.size());
  for_each_index(points.size(), threads, [&](int p) {
    const int e = points.element[p];
    const Vector<Dim> x = points.position(grid.mesh, p);
    // Linear in time through the mean and the end, and never negative.
    const double mean = flows.flux[p];
    const double change = 2.0 * (flux_at(grid, history.end, e, x).norm() - mean);
    flows.flux_change[p] = std::clamp(change, -2.0 * mean, 2.0 * mean);
  });
}

template <int Dim>
std::vector<double> element_means(const SoilMap<Dim>& soils, const std::vector<double>& at_points) {
  std::vector<double> means(soils.mesh().element_count(), 0.0);
  for (std::size_t e = 0; e < means.size(); ++e) {
    const int first = soils.points_begin(static_cast<int>(e));
    const int last = soils.points_begin(static_cast<int>(e) + 1);
    for (int p = first; p < last; ++p) means[e] += at_points[p] / (last - first);
  }
  return means;
}

template std::vector<double> element_means(const SoilMap<2>&, const std::vector<double>&);
template std::vector<double> element_means(const SoilMap<3>&, const std::vector<double>&);
template double acting_flux(const Grid<2>&, const SoilMap<2>&, int, double, double);
template PointFlows point_flows(const Grid<2>&, const SoilMap<2>&, const std::vector<double>&,
                                double, int);
template void find_flux_change(const Grid<2>&, const SoilMap<2>&, const FluxHistory&, PointFlows&,
                               int);
template double acting_flux(const Grid<3>&, const SoilMap<3>&, int, double, double);
template PointFlows point_flows(const Grid<3>&, const SoilMap<3>&, const std::vector<double>&,
                                double, int);
template void find_flux_change(const Grid<3>&, const SoilMap<3>&, const FluxHistory&, PointFlows&,
                               int);

}  // namespace suffuse
