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
  std::vector<double> flux;           ///< |q|, m/s; may be empty where no soil erodes by it
};

/// Pore volume per element and field node at the start, m3.
template <int Dim>
ElementField<Dim> initial_pore_volume(const Grid<Dim>& grid, const SoilMap<Dim>& soils);

/// The same now: with what the solid points have given since.
template <int Dim>
ElementField<Dim> pore_field(const Grid<Dim>& grid, const Skeleton<Dim>& solid);

/// Forecast of the pores: erosion up to a later time, before fines have moved. Keeps
/// references to the skeleton and the grid; holds until the skeleton changes.
template <int Dim>
class PoreForecast {
 public:
  /// `now`: the pores at `time`, s; `flux`: of the last interval.
  PoreForecast(const Grid<Dim>& grid, const Skeleton<Dim>& solid, double time, PoreState now,
               const FluxHistory& flux, int threads)
      : grid_(grid),
        solid_(solid),
        time_(time),
        now_(std::move(now)),
        flux_(flux),
        threads_(threads) {}

  [[nodiscard]] PoreState at(double time) const;

 private:
  const Grid<Dim>& grid_;
  const Skeleton<Dim>& solid_;
  double time_;
  PoreState now_;
  const FluxHistory& flux_;
  int threads_;
};

/// |q| in an element as far as it can erode, m/s, from a mean over `duration`, s: neither the
/// round-off of still water nor that of what the element holds is a drive.
template <int Dim>
double eroding_flux(const Grid<Dim>& grid, const SoilMap<Dim>& soils, int element, double flux,
                    double duration);

/// The same at the solid points, from volumes through faces per second; empty when no soil erodes
/// by it.
template <int Dim>
std::vector<double> erosion_flux(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                 const std::vector<double>& face_rate, double duration,
                                 int threads);

}  // namespace suffuse
