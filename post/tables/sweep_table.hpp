#pragma once

/// The table of a sweep, as workflows/sweep/sweep.py writes it: a row for each run, with the values
/// of the keys, how the run ended, and the columns of the table of runs.

#include <string>
#include <vector>

namespace suffuse {

struct SweepTable {
  std::string path;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< rows of the runs that are done

  /// The numbers of a column; NaN where a cell is empty. Throws InputError, naming `option`, for a
  /// column that is missing and for a column of words.
  [[nodiscard]] std::vector<double> numbers(const std::string& column,
                                            const std::string& option) const;
  /// The results folders, next to the table: RUN/RUN.results.
  [[nodiscard]] std::vector<std::string> results() const;
};

/// Throws FileError; InputError where no run is done.
SweepTable read_sweep(const std::string& path);

}  // namespace suffuse
