#pragma once

/// Global results of the flow: fluxes, extremes, hydraulic gradients, and the dissipated power.

#include "files/tables.hpp"
#include "flow/flow_solver.hpp"
#include "scene/scene.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

/// i = -grad h per element, from the linear field of its face pressures; in the explicit scheme
/// from node pressures, with first order and low accuracy at boundaries. Without gravity h = p /
/// (rho_w 9.81 m/s2).
template <int Dim>
VectorField<Dim> hydraulic_gradient(const Grid<Dim>& grid, const FlowState<Dim>& flow,
                                    const Scene& scene);

/// Writes the flow's columns of history.csv: fluxes through the outer boundary, extreme pressures
/// and speeds, errors, the share of the fines' weight in the driving power.
template <int Dim>
void describe_flow(const Grid<Dim>& grid, const FlowCoefficients<Dim>& coefficients,
                   const FlowState<Dim>& state, const Scene& scene, HistoryRow& row);

/// Power that the liquid dissipates in soil, W (per metre of thickness in 2D).
struct SeepagePower {
  double now = 0.0;           ///< integral of q . (rho_L g - grad p) over the soil
  double saturated = 0.0;     ///< over that which is saturated
  double initial_soil = 0.0;  ///< there, for the same flux with the initial conductivity
  /// k_eff / k_0: for flow along a column, its conductivity over the initial one. 0 without flow.
  [[nodiscard]] double conductivity_ratio() const {
    return saturated > 0.0 ? initial_soil / saturated : 0.0;
  }
};

/// \param mixture_density  rho_L per element, kg/m3
template <int Dim>
SeepagePower seepage_power(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                           const std::vector<double>& mixture_density, const FlowState<Dim>& flow,
                           const Scene& scene);

}  // namespace suffuse
