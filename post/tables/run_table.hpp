#pragma once

/// A table with one row per run: settings, cost, errors against exact solutions.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Names of the columns; docs/reference/file-formats.md says what they hold.
const std::vector<std::string>& run_table_columns();

/// CSV text: a line of names and a row per run. Numbers have all their digits. A cell is empty
/// where the column does not apply to the run; `inf` is the time of an event that never happens.
/// Throws FileError.
std::string run_table(const std::vector<ResultsReader>& runs);

/// Writes the table of `runs`; `-` is standard output. Throws FileError.
void write_run_table(const std::string& path, const std::vector<ResultsReader>& runs);

}  // namespace suffuse
