#pragma once

/// What the soils are to the flow and stays so through a run: retention and bedding, per element.

#include <algorithm>
#include <vector>

#include "flow/flow.hpp"
#include "physics/retention/retention_law.hpp"
#include "solid/soil_map.hpp"

namespace suffuse {

template <int Dim>
struct FlowSoils {
  std::vector<RetentionModel> retention;  ///< per element; empty: saturated at any pressure
  double head_per_pressure = 0.0;         ///< 1 / (rho_w 9.81 m/s2), m/Pa
  /// Per element: across the bedding, of length sqrt(1 - k_across / k_along); empty where every
  /// soil conducts alike in all directions.
  VectorField<Dim> bedding;

  [[nodiscard]] bool saturated() const { return retention.empty(); }
  /// S and k_r of an element's soil at a pressure in Pa, and dS/dp, 1/Pa.
  [[nodiscard]] double saturation(int e, double pressure) const {
    return retention[e].saturation(pressure * head_per_pressure);
  }
  [[nodiscard]] double capacity(int e, double pressure) const {
    return retention[e].capacity(pressure * head_per_pressure) * head_per_pressure;
  }
  /// Pressure at which dS/dp is largest, Pa; 0 in soil that stays saturated.
  [[nodiscard]] double steepest(int e) const {
    const RetentionModel& model = retention[e];
    return model.law ? model.law->steepest(model.parameters) / head_per_pressure : 0.0;
  }
  /// Not zero however dry the soil is: pressures are those of a linear system.
  [[nodiscard]] double relative_conductivity(int e, double pressure) const {
    constexpr double driest = 1e-20;
    return std::max(retention[e].relative_conductivity(pressure * head_per_pressure), driest);
  }
};

template <int Dim>
FlowSoils<Dim> flow_soils(const Scene& scene, const SoilMap<Dim>& soils);

}  // namespace suffuse
