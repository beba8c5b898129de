#pragma once

/// The step loop: follows the plan, writes the results.

#include <string>

#include "case/case_file.hpp"
#include "plan.hpp"

namespace suffuse {

/// Runs a case to its end into `folder`. Returns ExitCode::done, or ExitCode::interrupted after
/// SIGINT or SIGTERM (results so far are complete and say so). Throws NumericalError, after noting
/// it in run.json, and FileError. Keeps of the case what it goes on needing: hand it over where
/// there are many points.
template <int Dim>
int run_case(Case<Dim> c, const Plan& plan, const SolverOptions& options, const std::string& folder,
             bool quiet);

}  // namespace suffuse
