#pragma once

/// One row of numbers per run: how it was computed, what it cost, how far it is from what is exact.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Names of the columns; docs/file-formats.md says what they hold.
const std::vector<std::string>& run_table_columns();

/// CSV text with one line of names and a row per run. Numbers read back exactly; what does not
/// apply to a run is empty, `inf` is a time that never comes. Throws FileError.
std::string run_table(const std::vector<ResultsReader>& runs);

/// Writes the table of `runs`. Throws FileError.
void write_run_table(const std::string& path, const std::vector<ResultsReader>& runs);

}  // namespace suffuse
