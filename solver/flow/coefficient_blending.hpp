#pragma once

/// Makes the flow's coefficients continuous from step to step. Transport moves fines between two
/// steps, so densities, pore volumes and drags at the start of a step differ from those at the end
/// of the last one. Used directly, they would make the flux jump, and no step is short enough for a
/// jump. So a step starts with the last step's final coefficients and reaches the new ones over its
/// length. Where densities rise faster than by erosion alone, because fines arrive, the next step
/// expects this drift to continue.

#include <optional>
#include <utility>
#include <vector>

#include "grid/grid.hpp"
#include "mixed/flow.hpp"

namespace suffuse {

struct BlendingSettings {
  bool blend = true;       ///< false: steps of given length use coefficients as they are
  bool all = true;         ///< false: only the volume of water changes in time
  double min_density = 0;  ///< smallest expected density of the mixture, kg/m3
  double max_density = 0;  ///< largest expected density, kg/m3
};

template <int Dim>
class CoefficientBlending {
 public:
  explicit CoefficientBlending(BlendingSettings settings) : settings_(settings) {}

  /// Changes `coefficients`, those of erosion alone `elapsed` seconds after the start of a step, so
  /// that they continue those of the last step. `now`: at the start.
  void blend(double elapsed, const FlowCoefficients<Dim>& now,
             FlowCoefficients<Dim>& coefficients) const;

  /// Stores the coefficients at the end of the last step, or of a steady flow.
  void record(FlowCoefficients<Dim> used) { used_ = std::move(used); }
  /// Stores the coefficients that erosion alone would give at the end of the step.
  void expect(FlowCoefficients<Dim> expected) { expected_ = std::move(expected); }
  /// Compares the coefficients after transport, `now`, with those expected, after a step of `dt`
  /// seconds. `weight`, in (0, 1]: weight of this step's drift of densities against earlier ones.
  /// Returns the largest relative error of an expected resistance; with `losses`, the head loss of
  /// each element in any unit, the mean error weighted with these. Zero if nothing was expected.
  double learn(const Grid<Dim>& grid, const FlowCoefficients<Dim>& now, double dt, double weight,
               const std::vector<double>& losses = {});
  /// Call at the end of a step of `dt` seconds.
  void finish(double dt);
  /// Call when a step of `dt` seconds ended on a breakpoint: coefficients may jump, so they blend
  /// in less time.
  void shorten(double dt);

  /// The coefficients at the end of the last step that was solved; without elements before one was.
  [[nodiscard]] const FlowCoefficients<Dim>& used() const { return used_; }
  [[nodiscard]] bool expects() const { return expected_.has_value(); }

  void archive(auto& archive) {
    archive(used_, expected_, on_elements(density_drift_), blend_time_);
  }

 private:
  BlendingSettings settings_;
  FlowCoefficients<Dim> used_;  ///< at the end of the last step that was solved
  std::optional<FlowCoefficients<Dim>> expected_;
  /// Per element: rise of the mixture's density in recent steps beyond that by erosion, kg/(m3 s).
  std::vector<double> density_drift_;
  double blend_time_ = 0.0;  ///< coefficients blend in this time: the last step, or longer, s
};

}  // namespace suffuse
