#include "flow/flow_scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/errors.hpp"
#include "grid/field_values.hpp"
#include "mixed/implicit_thresholds.hpp"
#include "physics/drag.hpp"

namespace suffuse {
namespace {

/// The lowest and the highest of all ranks.
std::pair<double, double> range_of(const Ranks& ranks, const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return {smallest_of_all(ranks, low), largest_of_all(ranks, high)};
}

}  // namespace

template <int Dim>
void FlowScales::include(const Grid<Dim>& grid, const std::vector<double>& face_pressure,
                         const std::vector<double>& face_flux) {
  const Ranks& ranks = grid.ranks();
  const double largest = largest_of_all(ranks, largest_magnitude(face_flux));
  if (!flux_known) flux = std::max(flux, largest);
  double sum = 0.0;
  for (const int f : grid.own_faces()) sum += std::abs(face_flux[f]);
  flux_sum = std::max(flux_sum, sum_of_all(ranks, sum));
  const auto [low, high] = range_of(ranks, face_pressure);
  pressure = std::max(pressure, high - low);
}

void FlowScales::include_loads(double change, double stiffness) {
  has_bounds = false;
  pressure = std::max({pressure, change, implicit_thresholds.nothing_strain * stiffness});
}

void FlowScales::include_in_bounds(const Ranks& ranks, const std::vector<double>& face_pressure) {
  const auto [low, high] = range_of(ranks, face_pressure);
  min_pressure = std::min(min_pressure, low);
  max_pressure = std::max(max_pressure, high);
}

double FlowScales::overshoot(const Ranks& ranks, const std::vector<double>& face_pressure) const {
  if (!has_bounds || pressure == 0.0) return 0.0;
  const auto [low, high] = range_of(ranks, face_pressure);
  return std::max({0.0, high - max_pressure, min_pressure - low}) / pressure;
}

template <int Dim>
double filling_time(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                    bool air_moves, const std::vector<double>& face_flux) {
  double smallest = infinity;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const double pores = coefficients.porosity[e] * grid.volume[e];
    smallest = std::min(smallest, air_moves ? pores : coefficients.water_volume[e]);
  }
  return smallest_of_all(grid.ranks(), smallest) /
         largest_of_all(grid.ranks(), largest_magnitude(face_flux));
}

template <int Dim>
FlowScales find_scales(const Grid<Dim>& grid, ImplicitMixed<Dim>& scheme,
                       const FlowForcing<Dim>& at_start, const BoundaryValues<Dim>& values,
                       double end, bool has_gravity) {
  FlowScales scales;
  std::vector<double> times{0.0};
  if (values.vary()) {
    times.insert(times.end(), values.breakpoints().begin(), values.breakpoints().end());
    times.push_back(end);
  }
  bool prescribes_flux = false;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double time : times) {
    FlowForcing<Dim> forcing = at_start;
    values.update(time, forcing.conditions);
    for (const FaceCondition& condition : forcing.conditions) {
      if (condition.kind == FaceKind::pressure) {
        low = std::min(low, condition.value);
        high = std::max(high, condition.value);
      }
      prescribes_flux |= condition.fixes_flux() && condition.value != 0.0;
      prescribes_flux |= condition.kind == FaceKind::seepage;
    }
    try {
      const MixedStep<Dim> steady = scheme.saturated_steady(forcing);
      scales.include(grid, steady.end.face_pressure, steady.face_flux);
    } catch (const NumericalError&) {
      // Boundaries that prescribe fluxes only may have no steady flow: the flow sets the scales.
    }
  }
  low = smallest_of_all(grid.ranks(), low);
  high = largest_of_all(grid.ranks(), high);
  prescribes_flux = any_of_all(grid.ranks(), prescribes_flux);
  scales.has_bounds = low <= high && !prescribes_flux && !has_gravity;
  scales.min_pressure = low;
  scales.max_pressure = high;
  if (low <= high) scales.pressure = std::max(scales.pressure, high - low);
  return scales;
}

template <int Dim>
void raise_over_round_off(FlowScales& scales, const Grid<Dim>& grid,
                          const FlowCoefficients<Dim>& coefficients, const LiquidProperties& liquid,
                          double end) {
  Vector<Dim> low = grid.mesh.nodes.front();
  Vector<Dim> high = low;
  for (const Vector<Dim>& x : grid.mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Ranks& ranks = grid.ranks();
  for (int d = 0; d < Dim; ++d) {
    low[d] = smallest_of_all(ranks, low[d]);
    high[d] = largest_of_all(ranks, high[d]);
  }
  double pressure =
      implicit_thresholds.nothing * liquid.density * conductivity_gravity * (high - low).norm();
  if (std::isfinite(liquid.bulk_modulus)) {
    pressure = std::max(pressure, implicit_thresholds.state_round_off * liquid.bulk_modulus);
  }
  double flux = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const double steepest = steepest_shape(grid, e);
    const double mobility = coefficients.porosity[e] / coefficients.drag[e];
    flux = std::max({flux, mobility * pressure * grid.volume[e] * steepest * steepest,
                     implicit_thresholds.nothing * coefficients.water_volume[e] / end});
  }
  flux = largest_of_all(ranks, flux);
  double pores = 0.0;
  for (const int e : grid.own_elements()) pores += coefficients.porosity[e] * grid.volume[e];
  scales.pore_volume += sum_of_all(ranks, pores);
  const double faces = sum_of_all(ranks, *grid.own_faces().end() - *grid.own_faces().begin());
  scales.flux_sum = std::max(scales.flux_sum, flux * std::sqrt(faces));
  scales.pressure = std::max(scales.pressure, pressure);
  scales.flux_known = scales.flux > flux;
  scales.flux = std::max(scales.flux, flux);
}

template <int Dim>
double fastest_rate(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                    double bulk_modulus, bool inertia, const std::vector<double>& soil_storage) {
  double fastest = 0.0;
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (!soil_storage.empty() && soil_storage[e] == 0.0) continue;
    const double resistance = coefficients.drag[e] / coefficients.porosity[e];
    const double size = steepest_shape(grid, e);
    const double relaxation = coefficients.mixture_density[e] / coefficients.drag[e];
    double diffusivity =
        bulk_modulus * grid.volume[e] / (resistance * coefficients.water_volume[e]);
    if (!soil_storage.empty()) {
      const double storage = coefficients.water_volume[e] / bulk_modulus + soil_storage[e];
      diffusivity = grid.volume[e] / (resistance * storage);
    }
    if (inertia) {
      fastest = std::max(fastest, 1.0 / relaxation);
      if (std::isfinite(diffusivity)) {
        fastest = std::max(fastest, std::sqrt(diffusivity / relaxation) * size);
      }
    } else if (std::isfinite(diffusivity)) {
      fastest = std::max(fastest, diffusivity * size * size);
    }
  }
  return largest_of_all(grid.ranks(), fastest);
}

template void FlowScales::include(const Grid<2>&, const std::vector<double>&,
                                  const std::vector<double>&);
template double filling_time(const Grid<2>&, const FlowCoefficients<2>&, bool,
                             const std::vector<double>&);
template FlowScales find_scales(const Grid<2>&, ImplicitMixed<2>&, const FlowForcing<2>&,
                                const BoundaryValues<2>&, double, bool);
template void raise_over_round_off(FlowScales&, const Grid<2>&, const FlowCoefficients<2>&,
                                   const LiquidProperties&, double);
template double fastest_rate(const Grid<2>&, const FlowCoefficients<2>&, double, bool,
                             const std::vector<double>&);
template void FlowScales::include(const Grid<3>&, const std::vector<double>&,
                                  const std::vector<double>&);
template double filling_time(const Grid<3>&, const FlowCoefficients<3>&, bool,
                             const std::vector<double>&);
template FlowScales find_scales(const Grid<3>&, ImplicitMixed<3>&, const FlowForcing<3>&,
                                const BoundaryValues<3>&, double, bool);
template void raise_over_round_off(FlowScales&, const Grid<3>&, const FlowCoefficients<3>&,
                                   const LiquidProperties&, double);
template double fastest_rate(const Grid<3>&, const FlowCoefficients<3>&, double, bool,
                             const std::vector<double>&);

}  // namespace suffuse
