#pragma once

/// Retention and bedding of the soils, per element, as the flow uses them until the soils move.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "linear/directional_factor.hpp"
#include "mixed/flow.hpp"
#include "physics/retention/retention_law.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
struct FlowSoils {
  std::vector<RetentionModel> retention;  ///< per element; empty: saturated at any pressure
  /// Share of an element's pores that is soil's, per element; the rest is free space. Empty: all
  /// pores are soil's, and air does not move.
  std::vector<double> soil_share;
  RetentionModel free_space;
  double head_per_pressure = 0.0;  ///< 1 / (rho_w 9.81 m/s2), m/Pa
  /// Per element: conductivity over that along the bedding. Empty if every soil is isotropic.
  std::vector<DirectionalFactor<Dim>> bedding;

  [[nodiscard]] bool saturated() const { return retention.empty(); }
  /// Whether the air in pores moves with soil that moves.
  [[nodiscard]] bool air_moves() const { return !soil_share.empty(); }
  /// The state of an element at a pressure in Pa, with slopes in 1/Pa. k_r stays above zero, as
  /// pressures are solved for in a linear system.
  [[nodiscard]] RetentionState at(int e, double pressure) const {
    constexpr double driest = 1e-20;
    // If k_r were lower, pressures in free space are unbounded, and the iteration does not end.
    constexpr double film = 1e-6;
    const double psi = pressure * head_per_pressure;
    RetentionState state = retention[e].at(psi);
    if (is_mixed(e)) {
      RetentionState space = free_space.at(psi);
      keep_above(film, space);
      state = mixture(space, state, soil_share[e]);
    }
    keep_above(driest, state);
    state.capacity *= head_per_pressure;
    state.conductivity_slope *= head_per_pressure;
    return state;
  }
  /// Whether two elements have the same state at the same pressure.
  [[nodiscard]] bool are_alike(int e, int other) const {
    return retention[e] == retention[other] && (!air_moves() || soil_share[e] == soil_share[other]);
  }
  /// Pressures at which dS/dp of the soil and of free space in the element is largest, Pa; 0 where
  /// there is none, or where it stays saturated.
  [[nodiscard]] std::array<double, 2> steepest(int e) const {
    const auto of = [this](const RetentionModel& model) {
      return model.law ? model.law->steepest(model.parameters) / head_per_pressure : 0.0;
    };
    return {of(retention[e]), is_mixed(e) ? of(free_space) : 0.0};
  }
  /// Share of an element's suction that acts on the soil: S_e = (S - S_r) / (1 - S_r) >= 0 of what
  /// fills the element (Lu, Godt and Wu, Water Resour. Res. 46 (2010) W05515).
  [[nodiscard]] double suction_share(int e, double saturation) const {
    double residual = retention[e].residual_saturation;
    if (is_mixed(e)) residual = std::lerp(free_space.residual_saturation, residual, soil_share[e]);
    return std::max(0.0, (saturation - residual) / (1.0 - residual));
  }

 private:
  /// Whether the pores of an element are soil's only in part.
  [[nodiscard]] bool is_mixed(int e) const { return air_moves() && soil_share[e] < 1.0; }
  static void keep_above(double least, RetentionState& state) {
    if (state.relative_conductivity > least) return;
    state.relative_conductivity = least;
    state.conductivity_slope = 0.0;
  }
};

/// Retention and bedding per element. Elements that soil has left have the retention of free space.
/// \param porosity  per element, of water and air; empty: of all that is not solid
template <int Dim>
FlowSoils<Dim> flow_soils(const Scene& scene, const Skeleton<Dim>& solid,
                          const std::vector<double>& porosity = {});

}  // namespace suffuse
