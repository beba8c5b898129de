#pragma once

/// How far a run is from values that are known: exact ones, or those of a finer run.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Distances of a run from the values of one quantity, relative: sum of |difference| over sum of
/// |value|, root of the sums of squares likewise, largest |difference| over largest |value|.
struct ReferenceError {
  std::string quantity;
  std::size_t values = 0;
  double l1 = 0.0;
  double l2 = 0.0;
  double max = 0.0;
};

/// A table of known values with its path, for messages.
struct ReferenceTable {
  std::string path;
  Table values;
};

/// Reads a CSV file. It has a column `t` (s), either both `x` and `y` (m) or neither, and one
/// column or more of values. Throws FileError; InputError for a table that is not like that, or
/// one that has nothing but zeros in a column of values.
ReferenceTable read_reference_table(const std::string& path);

/// One for each column of values. With places they are fields, as `sample` takes them there, the
/// components of a vector as NAME_x and NAME_y. Without places they are columns of history.csv or
/// ledger.csv, linear between rows, or `mean_` and the name of a field of the elements: its volume
/// mean over the model, linear between snapshots.
///
/// Throws InputError for a quantity that the run does not have, or a time or place outside it.
std::vector<ReferenceError> reference_errors(const ResultsReader& run,
                                             const ReferenceTable& reference);

/// For people: a line per quantity.
std::string error_text(const std::vector<ReferenceError>& errors);

/// Columns quantity, values, l1, l2, max. Throws FileError.
void write_errors(const std::string& path, const std::vector<ReferenceError>& errors);

}  // namespace suffuse
