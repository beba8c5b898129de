#pragma once

/// The liquid at the solid points over an interval, as far as the exchange of fines needs it.

#include <algorithm>
#include <utility>
#include <vector>

#include "grid/extrapolated_flux.hpp"
#include "grid/grid.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// Vectors may be empty if no law needs them.
struct PointFlows {
  double start = 0.0;        ///< of the interval, s
  double end = 0.0;          ///< s
  std::vector<double> flux;  ///< per solid point: mean of |q|, m/s
  /// Per solid point: change of |q| over the interval, m/s; none where soil has an
  /// `erosion.length`.
  std::vector<double> flux_change;
  /// Mean of |q| as erosion sees it, m/s; empty if no soil has an `erosion.length`.
  std::vector<double> eroding_flux;
  std::vector<double> resistance;     ///< per solid point: see PlaceFlow
  std::vector<double> concentration;  ///< per solid point: present c
  std::vector<double> saturation;     ///< per element: liquid per pore volume
  LiquidMotion motion = LiquidMotion::stays;

  /// Takes concentration, saturation and motion of another flow.
  void take_liquid(const PointFlows& flows) {
    concentration = flows.concentration;
    saturation = flows.saturation;
    motion = flows.motion;
  }
  /// |q| that erosion sees at a point at the ends of a part of the interval, m/s; may be unset if
  /// no law needs it.
  [[nodiscard]] std::pair<double, double> flux_ends(int point, double from, double to) const {
    if (flux.empty()) return {unset, unset};
    const double mean = eroding_flux.empty() ? flux[point] : eroding_flux[point];
    if (flux_change.empty()) return {mean, mean};
    const double slope = flux_change[point] / (end - start);
    const double middle = 0.5 * (start + end);
    return {std::max(0.0, mean + slope * (from - middle)),
            std::max(0.0, mean + slope * (to - middle))};
  }
  /// Flow at a point in `element` from `from` to `to`, s, a part of the interval.
  [[nodiscard]] PlaceFlow at(int point, int element, double from, double to) const;
};

/// Flows at solid points of a flux: volumes through faces per second, mean over `duration`, s.
/// `flux_change` and `concentration` stay empty.
template <int Dim>
PointFlows point_flows(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                       const std::vector<double>& face_rate, double duration, int threads);

/// Sets `flux_change` if some soil needs it.
template <int Dim>
void find_flux_change(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const FluxHistory& history,
                      PointFlows& flows, int threads);

/// |q| in an element that can act on the soil, m/s, from a mean over `duration`, s: zero if it is
/// round-off of still water or of the element's contents. Otherwise round-off would erode, and as
/// fines are heavy, still water would begin to flow.
template <int Dim>
double acting_flux(const Grid<Dim>& grid, const SoilMap<Dim>& soils, int element, double flux,
                   double duration);

/// Mean of the values of the solid points in each element; 0 without points.
template <int Dim>
std::vector<double> element_means(const SoilMap<Dim>& soils, const std::vector<double>& at_points);

}  // namespace suffuse
