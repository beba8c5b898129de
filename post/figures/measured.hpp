#pragma once

/// Points that a user measured, drawn over curves of runs.

#include <string>
#include <vector>

#include "drawing/chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Points measured in the tests that runs stand for.
struct MeasuredPoints {
  std::string path;
  std::vector<NamedTable> runs;  ///< by the label of the run; unnamed if the file names none
};

/// Throws InputError for an error in the file of measured points; `where` begins with its path.
[[noreturn]] void refuse_measured(const std::string& where, const std::string& found,
                                  const std::string& expected);

/// Reads a table of numbers, with times in seconds. A column `run` says to which run a point
/// belongs. Throws InputError for an unknown unit of time, FileError.
MeasuredPoints read_measured(const std::string& path);

/// Adds points of a column against `x` to a chart, as markers. `labels`: labels of the runs; points
/// of a run have its style. Throws InputError for points of a run that is missing.
void add_measured(const MeasuredPoints& measured, const std::string& x, const std::string& column,
                  const std::vector<std::string>& labels, Chart& chart);

}  // namespace suffuse
