#pragma once

/// Errors of a run against reference values: exact ones, or those of a finer run.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Relative errors of one quantity, with the differences d of the run from the reference values v:
/// l1 = sum |d| / sum |v|, l2 = sqrt(sum d^2 / sum v^2), max = max |d| / max |v|.
struct ReferenceError {
  std::string quantity;
  std::size_t values = 0;  ///< number of reference values
  double l1 = 0.0;
  double l2 = 0.0;
  double max = 0.0;
};

/// A table of reference values, and its path for messages.
struct ReferenceTable {
  std::string path;
  Table values;
};

/// Reads a CSV file with a column `t` (s), columns `x` and `y` (m) or neither, and at least one
/// column of values. Throws FileError; InputError for another layout, for values that are not
/// finite and for a column of values that are all zero.
ReferenceTable read_reference_table(const std::string& path);

/// One error for each column of values. Where the table has places, columns name fields, which are
/// evaluated there as in `sample`; the components of a vector are NAME_x and NAME_y. Where it has
/// none, columns name those of history.csv or ledger.csv, linear between rows, or are `mean_NAME`:
/// the volume mean of a field of the elements over the model, linear between snapshots.
///
/// Throws InputError for a quantity that the run does not have, or a time or place outside it.
std::vector<ReferenceError> reference_errors(const ResultsReader& run,
                                             const ReferenceTable& reference);

/// A line of text per quantity.
std::string error_text(const std::vector<ReferenceError>& errors);

/// Writes a CSV table with the columns quantity, values, l1, l2, max; `-` is standard output.
/// Throws FileError.
void write_errors(const std::string& path, const std::vector<ReferenceError>& errors);

}  // namespace suffuse
