#pragma once

/// Makes the flow's coefficients continuous from step to step. Between two steps transport moves
/// fines, so that densities, pore volumes and drags at the start of a step differ from those at the
/// end of the last one. Taken as they are, they would be a jump of the flux that no step is short
/// enough for. So a step starts with the coefficients that the last one ended with and reaches the
/// new ones over its length; and where densities keep rising faster than erosion alone explains,
/// because fines flow there, the next step expects them to go on.

#include <optional>
#include <utility>
#include <vector>

#include "mixed/flow.hpp"

namespace suffuse {

struct BlendingSettings {
  bool blend = true;       ///< false: steps of given length take coefficients as they are
  bool all = true;         ///< false: only the volume of water changes in time
  double min_density = 0;  ///< of the mixture: no expected density is below, kg/m3
  double max_density = 0;  ///< nor above, kg/m3
};

template <int Dim>
class CoefficientBlending {
 public:
  explicit CoefficientBlending(BlendingSettings settings) : settings_(settings) {}

  /// Changes `coefficients`, those `elapsed` seconds after the start of a step as erosion alone
  /// will make them, so that they continue those of the last step. `now`: at the start.
  void blend(double elapsed, const FlowCoefficients<Dim>& now,
             FlowCoefficients<Dim>& coefficients) const;

  /// The last step, or a steady flow, ended with these coefficients.
  void record(FlowCoefficients<Dim> used) { used_ = std::move(used); }
  /// Erosion alone would have made these of the coefficients at the end of the step.
  void expect(FlowCoefficients<Dim> expected) { expected_ = std::move(expected); }
  /// Compares the coefficients after transport, `now`, with those expected, after a step of `dt`
  /// seconds. `weight`, in (0, 1]: of the drift of densities in this step against earlier ones.
  /// Returns the largest relative error of an expected resistance, or with `losses`, what each
  /// element takes of the head, in any unit, the mean weighted with these: by so much the flow as a
  /// whole is off. Zero where nothing was expected.
  double learn(const FlowCoefficients<Dim>& now, double dt, double weight,
               const std::vector<double>& losses = {});
  /// A step of `dt` seconds is over.
  void finish(double dt);
  /// A breakpoint ended a step of `dt` seconds: coefficients may jump, so they blend in less time.
  void shorten(double dt);

  [[nodiscard]] bool expects() const { return expected_.has_value(); }

  void archive(auto& archive) { archive(used_, expected_, density_drift_, blend_time_); }

 private:
  BlendingSettings settings_;
  FlowCoefficients<Dim> used_;  ///< at the end of the last step that was solved
  std::optional<FlowCoefficients<Dim>> expected_;
  /// Per element: rise of the mixture's density in the last steps beyond what erosion explains,
  /// kg/(m3 s).
  std::vector<double> density_drift_;
  double blend_time_ = 0.0;  ///< in which coefficients blend: the last step, or longer, s
};

}  // namespace suffuse
