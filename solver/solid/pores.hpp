#pragma once

/// Porosity, water and fines in the pores of each element: now, and forecast from erosion.

#include <vector>

#include "grid/element_field.hpp"
#include "grid/extrapolated_flux.hpp"
#include "grid/grid.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

/// Per element.
struct PoreState {
  std::vector<double> porosity;       ///< n_L
  std::vector<double> water_volume;   ///< liquid minus fluidised fines, m3
  std::vector<double> concentration;  ///< c
  std::vector<double> air_volume;     ///< m3; empty where all soil is saturated
  std::vector<double> flux;           ///< |q|, m/s; empty if no soil transfers momentum

  /// Adds the pores that moving solid opens. `gained`: per element, m3, empty if it does not move;
  /// `volume`: of the elements, m3.
  void open(const std::vector<double>& gained, const std::vector<double>& volume);
};

/// Pore volume per element and field node at the start, m3.
template <int Dim>
ElementField<Dim> initial_pore_volume(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

/// Pore volume per element and field node now, m3: includes the volume that solid points have lost
/// since the start.
template <int Dim>
ElementField<Dim> pore_field(const Grid<Dim>& grid, const Skeleton<Dim>& solid);

/// |q| of an interval that acts on the soil of each element, m/s: for soil with an `erosion.length`
/// that which erosion sees. Empty if no law needs it.
template <int Dim>
std::vector<double> acting_element_flux(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                                        const FluxHistory& history, int threads);

/// Forecast of the pores: erosion up to a later time, without transport of fines. Keeps references
/// to the skeleton and the grid; valid until the skeleton changes.
template <int Dim>
class PoreForecast {
 public:
  /// `now`: the pores at `time`, s; `liquid`: at the solid points in the last interval; `flux`: of
  /// that interval.
  PoreForecast(const Grid<Dim>& grid, const Skeleton<Dim>& solid, double time, PoreState now,
               const PointFlows& liquid, const FluxHistory& flux, int threads)
      : grid_(grid),
        solid_(solid),
        time_(time),
        now_(std::move(now)),
        liquid_(liquid),
        flux_(flux),
        threads_(threads) {}

  [[nodiscard]] PoreState at(double time) const;
  /// n_L per solid point then, without deformation; empty if it does not change.
  [[nodiscard]] std::vector<double> of_points_at(double time) const;

 private:
  const Grid<Dim>& grid_;
  const Skeleton<Dim>& solid_;
  double time_;
  PoreState now_;
  const PointFlows& liquid_;
  const FluxHistory& flux_;
  int threads_;
};

}  // namespace suffuse
