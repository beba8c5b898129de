#pragma once

/// Runs a case from its start, or from the last state of a stopped run; writes its results folder.

#include <string>

#include "case/case_file.hpp"
#include "driver/plan.hpp"

namespace suffuse {

struct RunOptions {
  bool quiet = false;   ///< no progress
  bool resume = false;  ///< continue the run in the folder, if there is one
  bool force = false;   ///< replace the results of another case
  /// Wall time without a snapshot after which a run writes a checkpoint, s; 0: never.
  double checkpoint_every = 600.0;
};

/// Runs a case to its end into `folder`. Returns ExitCode::done, or ExitCode::interrupted after
/// a signal of `catch_interrupts` (with a checkpoint, and a message how to continue). A resumed run
/// gives the same bits as one that never stopped, on any number of threads. Throws NumericalError
/// and FileError, noted in run.json, and InputError if the folder holds the results of another
/// case. Takes the case by value, to free its liquid points when the model has its own: move it in.
/// `case_path` is for messages.
template <int Dim>
int run_case(Case<Dim> c, const Plan& plan, const SolverOptions& options, const std::string& folder,
             const RunOptions& run, const std::string& case_path = "NAME.case.h5");

}  // namespace suffuse
