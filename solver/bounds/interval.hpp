#pragma once

/// How far a number can be off.

namespace suffuse {

struct Interval {
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
  [[nodiscard]] double half() const { return 0.5 * (high - low); }
};

/// Estimates of the errors of the last step, in the unit of the number; 0 where there are none.
struct StepEstimates {
  double time = 0.0;       ///< because the step has a length
  double transport = 0.0;  ///< because transport changed the soil after the flow was solved
};

}  // namespace suffuse
