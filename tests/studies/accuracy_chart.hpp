#pragma once

/// Charts of the accuracy study: wall time of runs against their error, from the table that
/// `make -C workflows accuracy` writes.

#include <string>
#include <vector>

#include "drawing/chart.hpp"

namespace suffuse {

/// A row of the table: one run.
struct AccuracyRun {
  std::string problem;
  std::string scheme;    ///< FORMULATION-STEPPING: sp, dp, paper; scaled, explicit, drag, implicit
  std::string quantity;  ///< the field or history column compared
  double error = 0.0;    ///< relative, L1
  double seconds = 0.0;  ///< wall time
};

/// Reads the columns problem, scheme, quantity, error_l1 and seconds of a CSV file, and no others.
/// Throws FileError with file and line; InputError for an unknown scheme, or numbers that are not
/// positive: the axes are logarithmic.
std::vector<AccuracyRun> read_accuracy_runs(const std::string& path);

/// The runs for which no other run has both a smaller error and a shorter time, in order of
/// falling error.
std::vector<AccuracyRun> best_runs(std::vector<AccuracyRun> runs);

/// Two charts of a problem with equal axes: single-point runs, double-point runs. Each run has a
/// marker; a line joins the best runs of each scheme. Throws InputError for a problem that the
/// table does not have.
std::vector<Chart> accuracy_charts(const std::vector<AccuracyRun>& runs,
                                   const std::string& problem);

}  // namespace suffuse
