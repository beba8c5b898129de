#pragma once

/// The plan of a run: which passes it runs and which it skips, with which steps. It is made once,
/// from the scene, before anything runs.

#include <limits>
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
};

struct Plan : ModelOptions {
  StabilityLimit limit;  ///< explicit only: the smallest that is expected in the run
  /// Only with inertia: faster liquid crosses the model before drag slows or accelerates it to its
  /// steady speed, m/s. The momentum that it carries along is not in the equations.
  double speed_that_drag_follows = std::numeric_limits<double>::infinity();
  /// Implicit only: after it a flow that starts from rest is steady to about 1e-5 of itself, s.
  double settling_time = 0.0;
  /// Implicit only, without inertia: elements with an obtuse angle, which can take pressures beyond
  /// those of the boundaries.
  std::optional<int> obtuse_elements;
  std::vector<std::string> sentences;  ///< what runs, what is skipped, and why
  std::vector<std::string> warnings;
};

/// Throws InputError for a step above the stability limit, for prescribed fluxes that contradict
/// each other and for points that the scheme cannot handle.
template <int Dim>
Plan make_plan(const Case<Dim>& c, const SolverOptions& options);

}  // namespace suffuse
