#pragma once

/// Magnitudes of fluxes and pressures of a scene, from its boundary conditions. Errors of the
/// implicit flow are relative to these.

#include <vector>

#include "boundary/face_conditions.hpp"
#include "grid/grid.hpp"
#include "mixed/flow.hpp"
#include "mixed/implicit_mixed.hpp"
#include "scene/scene.hpp"

namespace suffuse {

struct FlowScales {
  double flux = 0.0;         ///< largest through a face, m3/s
  double pressure = 0.0;     ///< largest minus smallest at the faces, Pa
  double flux_sum = 0.0;     ///< largest sum over all faces, m3/s
  double pore_volume = 0.0;  ///< of the model, m3
  bool flux_known = false;   ///< from the boundary conditions; otherwise the flow raises it
  /// Only prescribed pressures drive the flow: pressures stay between these two, Pa.
  bool has_bounds = false;
  double min_pressure = 0.0;
  double max_pressure = 0.0;

  /// Raises the scales to those of a flow with these pressures and fluxes at the faces. A known
  /// flux scale stays: a short peak, as at a start from rest, does not count.
  template <int Dim>
  void include(const Grid<Dim>& grid, const std::vector<double>& face_pressure,
               const std::vector<double>& face_flux);
  /// Includes loads on moving soil, which also drive the flow; pressures then have no bounds.
  ///
  /// \param change     largest change of a load, Pa
  /// \param stiffness  of the soil, Pa: stresses of tiny strains do not count
  void include_loads(double change, double stiffness);
  /// Widens the bounds to these pressures, from which the flow starts.
  void include_in_bounds(const Ranks& ranks, const std::vector<double>& face_pressure);
  /// Largest excess of pressures over their bounds, over the pressure scale; zero without bounds.
  [[nodiscard]] double overshoot(const Ranks& ranks,
                                 const std::vector<double>& face_pressure) const;

  void archive(auto& archive) {
    archive(flux, pressure, flux_sum, pore_volume, flux_known, has_bounds, min_pressure,
            max_pressure);
  }
};

/// Time in which the largest flux fills the pores of the smallest element, s; infinite at rest.
/// Elements of air, where air moves, hold next to no water and count by their pores.
template <int Dim>
double filling_time(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                    bool air_moves, const std::vector<double>& face_flux);

/// The scales of the steady flows under the boundary conditions at the start, at each kink of their
/// values and at the end. `at_start`: coefficients and conditions. If no steady flow exists, as
/// with prescribed fluxes only, the scales are zero or smaller.
template <int Dim>
FlowScales find_scales(const Grid<Dim>& grid, ImplicitMixed<Dim>& scheme,
                       const FlowForcing<Dim>& at_start, const BoundaryValues<Dim>& values,
                       double end, bool has_gravity);

/// Raises the scales above what counts as nothing: see ImplicitThresholds::nothing. `end` of the
/// run, s.
template <int Dim>
void raise_over_round_off(FlowScales& scales, const Grid<Dim>& grid,
                          const FlowCoefficients<Dim>& coefficients, const LiquidProperties& liquid,
                          double end);

/// Largest rate of change in the flow, 1/s: relaxation of the velocity, waves and diffusion of the
/// pressure through the smallest element. Zero if nothing limits it. `soil_storage`: volume per
/// pressure that moving soil makes room for, per element, m3/Pa; if given, only elements with such
/// storage count.
template <int Dim>
double fastest_rate(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                    double bulk_modulus, bool inertia,
                    const std::vector<double>& soil_storage = {});

}  // namespace suffuse
