#pragma once

/// How far a flow can be off: what its last step adds is recorded as it is taken, and the bounds
/// are computed at the first call.

#include <optional>
#include <vector>

#include "bounds/discharge_bounds.hpp"
#include "mixed/mixed_flow.hpp"

namespace suffuse {

template <int Dim>
class FlowErrors {
 public:
  /// A step from `start` to `end`, `ahead` times as long as the one before, which started from
  /// `previous` (if there is one). Its errors are `share` of the distance of `end` from a straight
  /// line through the two before; none where that is zero.
  void record(const std::optional<MixedFlow<Dim>>& previous, const MixedFlow<Dim>& start,
              const MixedStep<Dim>& end, double ahead, double share);
  /// Bounds and estimates of a state, which was solved with the coefficients `used` (of no elements
  /// where none was). A steady flow has the same in each row of the tables: they are found anew
  /// only if something has changed. Throws NumericalError.
  const DischargeBounds& find(SeepageState<Dim> state, const FlowCoefficients<Dim>& used);

  void archive(auto& archive) { archive(of_step_); }

 private:
  LastStepErrors of_step_;
  std::optional<DischargeBounds> bounds_;
  std::vector<std::vector<double>> found_for_;  ///< what may have changed since
};

}  // namespace suffuse
