#pragma once

/// Decides from the scene, once and before anything runs, what a run does and what it leaves out.

#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "flow/scene_flow.hpp"
#include "flow/stability_limit.hpp"

namespace suffuse {

struct SolverOptions {
  int threads = 1;
  bool no_skip = false;
};

struct Plan {
  FlowOptions flow;
  StabilityLimit limit;   ///< explicit: the smallest the run is expected to meet
  bool transport = true;  ///< fluidised grains move
  bool erosion = true;
  std::vector<std::string> sentences;  ///< what runs, what is skipped, and why
  std::vector<std::string> warnings;
};

/// Throws InputError for a step above the stability limit and for what the scheme cannot do.
template <int Dim>
Plan make_plan(const Case<Dim>& c, const SolverOptions& options);

}  // namespace suffuse
