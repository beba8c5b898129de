#pragma once

/// Exact fluidised grains in a column that clean water enters at uniform Darcy flux q; independent
/// of the solver. Along a path of the liquid D ln(1 - c)/Dt = -phi_e / n_L, and where porosity is
/// uniform in space (1 - c) n_L stays constant on the path: n_f = n_L(t) - n_L(t_in) with
/// x = integral of q / n_L from t_in to t.

#include <optional>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// A specimen of uniform initial porosity between clean inflow and outflow.
struct ColumnFlow {
  Soil soil;                ///< with a law whose porosity is known exactly at a constant flux
  double porosity = unset;  ///< n_0
  double length = unset;    ///< length of the specimen along the flow, m
  double width = unset;     ///< m
  double flux = unset;      ///< q > 0, m/s
};

/// The steady flow through the one eroding soil of a built-in column, or nothing where the scene
/// has no exact solution: another geometry, several eroding soils, a gradient of porosity, fines
/// that enter, conditions on the sides, boundary values that change in time, a start from an
/// earlier run, soil that moves or drains, a random field or tilted bedding. The flux must follow
/// from a boundary (`darcy_flux`, `velocity` times a constant porosity) or from the heads at both
/// ends (k i, Darcy's drag, constant conductivity and viscosity, no gravity).
std::optional<ColumnFlow> column_flow(const ResultsReader& run);

class ColumnFines {
 public:
  /// `end`: the latest time of any later call, s.
  ColumnFines(const ColumnFlow& flow, double end);

  /// c at distance `x` (m) from the inlet of the specimen; at `length`, c of the outflow.
  [[nodiscard]] double concentration(double x, double t) const;
  /// Fluidised grains in the specimen, kg (per metre of thickness).
  [[nodiscard]] double fines(double t) const;
  /// Grains that left the specimen since the start, kg (per metre of thickness).
  [[nodiscard]] double fines_out(double t) const;

 private:
  [[nodiscard]] double porosity(double t) const;
  /// Integral of q / n_L over an interval too short to need more than three Gauss points.
  [[nodiscard]] double path_between(double from, double to) const;
  /// Path of the liquid since erosion started; negative before that.
  [[nodiscard]] double path(double t) const;
  /// Time at which the liquid entered that is at `x` at time `t`.
  [[nodiscard]] double entry(double x, double t) const;

  ColumnFlow flow_;
  std::vector<double> times_;
  std::vector<double> paths_;
};

}  // namespace suffuse
