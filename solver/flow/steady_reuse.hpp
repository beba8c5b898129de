#pragma once

/// Decides when a flow is steady, so that later steps reuse its fluxes without a solution, and when
/// this ends: as soon as anything that drives or resists the flow changes.

#include <optional>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "mixed/flow.hpp"

namespace suffuse {

struct SteadyReuseSettings {
  bool allowed = true;
  double tolerance = 0.0;            ///< of the flow's errors, relative to its scales
  bool has_gravity = false;          ///< densities drive the flow
  bool prescribes_velocity = false;  ///< porosities drive the flow at the boundary
};

/// Whether boundary values are constant from `time` to their next kink or the end of the run.
/// `conditions`: those at `time`, s.
template <int Dim>
bool boundary_values_rest(const Grid<Dim>& grid, const BoundaryValues<Dim>& values,
                          const std::vector<FaceCondition>& conditions, double time, double end);

template <int Dim>
class SteadyReuse {
 public:
  /// Keeps a reference to the grid.
  SteadyReuse(const Grid<Dim>& grid, SteadyReuseSettings settings)
      : grid_(grid), settings_(settings) {}

  /// Whether a steady flow is in use.
  [[nodiscard]] bool active() const { return coefficients_.has_value(); }
  /// Whether reuse is allowed at all.
  [[nodiscard]] bool allowed() const { return settings_.allowed; }
  /// Starts to reuse a flow that is steady with these coefficients.
  void start(FlowCoefficients<Dim> coefficients) { coefficients_ = std::move(coefficients); }
  void stop() { coefficients_.reset(); }
  /// Stops if these coefficients resist or drive the flow differently from those at the start.
  void check(const FlowCoefficients<Dim>& coefficients);

  /// Whether two fields of values per face are one steady field; `scale`: of such values.
  [[nodiscard]] bool is_close(const std::vector<double>& a, const std::vector<double>& b,
                              double scale) const;
  /// Whether sources have changed so much that the steady flow must be solved again. Their sum
  /// counts, as it may cross one face. Sources per element and `flux_scale` in m3/s.
  [[nodiscard]] bool needs_update(const std::vector<double>& source,
                                  const std::vector<double>& new_source, double flux_scale) const;

  void archive(auto& archive) { archive(coefficients_); }

 private:
  [[nodiscard]] bool resists_alike(const FlowCoefficients<Dim>& a,
                                   const FlowCoefficients<Dim>& b) const;

  const Grid<Dim>& grid_;
  SteadyReuseSettings settings_;
  std::optional<FlowCoefficients<Dim>> coefficients_;  ///< of the steady flow in use
};

}  // namespace suffuse
