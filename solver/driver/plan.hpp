#pragma once

/// Decides from the scene, once and before anything runs, what a run does and what it leaves out.

#include <limits>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "flow/stability_limit.hpp"
#include "formulation/two_phase_model.hpp"

namespace suffuse {

struct SolverOptions {
  int threads = 1;
  bool no_skip = false;
};

struct Plan : ModelOptions {
  StabilityLimit limit;  ///< explicit: the smallest the run is expected to meet
  /// Where inertia counts: liquid that is faster passes the model before drag would have brought it
  /// to its speed, m/s. The momentum that it carries along is not in the equations.
  double speed_that_drag_follows = std::numeric_limits<double>::infinity();
  /// Implicit only: after it a flow that starts from rest is steady to about 1e-5 of itself, s.
  double settling_time = 0.0;
  std::vector<std::string> sentences;  ///< what runs, what is skipped, and why
  std::vector<std::string> warnings;
};

/// Throws InputError for a step above the stability limit and for what the scheme cannot do.
template <int Dim>
Plan make_plan(const Case<Dim>& c, const SolverOptions& options);

}  // namespace suffuse
