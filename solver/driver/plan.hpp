#pragma once

/// The plan of a run: its passes, those that are skipped, and its steps. It is made once from the
/// scene, before the run.

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "explicit/stability_limit.hpp"
#include "formulation/two_phase_model.hpp"

namespace suffuse {

struct SolverOptions {
  int threads = 1;
  bool no_skip = false;
  /// That share the run; all have to make the same calls.
  std::shared_ptr<const Ranks> ranks = std::make_shared<Ranks>();
};

struct Plan : ModelOptions {
  StabilityLimit limit;  ///< explicit only: smallest limit expected in the run
  /// Only with inertia: speed above which liquid crosses the model before drag makes it steady,
  /// m/s. The equations lack the convected momentum of such liquid.
  double speed_that_drag_follows = std::numeric_limits<double>::infinity();
  /// Implicit only: time after which a flow from rest is steady to about 1e-5, s.
  double settling_time = 0.0;
  /// Implicit only, without inertia: number of elements with an obtuse angle, which can cause
  /// pressures outside the range of the boundaries.
  std::optional<int> obtuse_elements;
  std::vector<std::string> sentences;  ///< what runs, what is skipped, and why
  std::vector<std::string> warnings;
};

/// Throws InputError for a step above the stability limit, for prescribed fluxes that contradict
/// each other and for points that the scheme cannot handle.
template <int Dim>
Plan make_plan(const Case<Dim>& c, const SolverOptions& options);

}  // namespace suffuse
