#pragma once

/// The plan of a run: its passes, those that are skipped, and its steps. It is made once from the
/// scene, before the run.

#include <memory>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "driver/row_checks.hpp"
#include "explicit/stability_limit.hpp"
#include "formulation/two_phase_model.hpp"

namespace suffuse {

struct SolverOptions {
  int threads = 1;
  bool no_skip = false;
  /// Ranks that share the run; all have to make the same calls.
  std::shared_ptr<const Ranks> ranks = std::make_shared<Ranks>();
};

struct Plan : ModelOptions {
  StabilityLimit limit;  ///< explicit only: smallest limit expected in the run
  RowLimits row_limits;
  std::vector<std::string> sentences;  ///< what runs, what is skipped, and why
  std::vector<std::string> warnings;
};

/// Throws InputError for a step above the stability limit, for prescribed fluxes that contradict
/// each other and for points that the scheme cannot handle.
template <int Dim>
Plan make_plan(const Case<Dim>& c, const SolverOptions& options);

}  // namespace suffuse
