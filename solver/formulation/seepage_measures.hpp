#pragma once

/// What results say of the flow as a whole: fluxes and extremes, hydraulic gradients, and the power
/// that water spends on the soil.

#include "files/tables.hpp"
#include "flow/flow_solver.hpp"
#include "scene/scene.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// i = -grad h per element, of the linear field of its face pressures; in the explicit scheme,
/// which has none, of the node pressures: of first order there, and rough at boundaries. Without
/// gravity h = p / (rho_w 9.81 m/s2).
template <int Dim>
VectorField<Dim> hydraulic_gradient(const Grid<Dim>& grid, const FlowState<Dim>& flow,
                                    const Scene& scene);

/// Writes what a row of history.csv says of the flow: fluxes through the outer boundary, extreme
/// pressures and speeds, errors, the share of the fines' weight in what drives it.
template <int Dim>
void describe_flow(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                   const FlowState<Dim>& state, const Scene& scene, HistoryRow& row);

/// Power that water spends on soil, W (per metre of thickness in 2D).
struct SeepagePower {
  double now = 0.0;           ///< integral of rho_w g q . i over the soil
  double initial_soil = 0.0;  ///< that the same flux would take with the conductivity of the start

  /// k_eff / k_0: in flow along a column, the conductivity of the whole over that at the start. 0
  /// where nothing flows.
  [[nodiscard]] double conductivity_ratio() const { return now > 0.0 ? initial_soil / now : 0.0; }
};

template <int Dim>
SeepagePower seepage_power(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                           const FlowState<Dim>& flow, const Scene& scene);

}  // namespace suffuse
