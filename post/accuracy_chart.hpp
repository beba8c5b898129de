#pragma once

/// Wall time against error, from the table of `make -C workflows accuracy`.

#include <string>
#include <vector>

#include "chart.hpp"

namespace suffuse {

/// A row of the table: one run.
struct AccuracyRun {
  std::string problem;
  std::string scheme;    ///< FORMULATION-WAY: sp, dp, paper; scaled, explicit, drag, implicit
  std::string quantity;  ///< whose error it is
  double error = 0.0;    ///< relative, L1
  double seconds = 0.0;  ///< wall time
};

/// Reads the columns problem, scheme, quantity, error_l1 and seconds of a CSV file, and no others.
/// Throws FileError with file and line; InputError for a scheme that is none, or numbers that are
/// not positive, which no logarithmic axis has a place for.
std::vector<AccuracyRun> read_accuracy_runs(const std::string& path);

/// The runs that no other one beats in both time and error, by falling error.
std::vector<AccuracyRun> best_runs(std::vector<AccuracyRun> runs);

/// Single-point and double-point runs of a problem beside each other, on the same axes. A marker
/// for each run; a line through the best of each scheme. Throws InputError for a problem that the
/// table does not have.
std::vector<Chart> accuracy_charts(const std::vector<AccuracyRun>& runs,
                                   const std::string& problem);

}  // namespace suffuse
