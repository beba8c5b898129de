#pragma once

/// The table files of a results folder, and their lines.

#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "files/tables.hpp"

namespace suffuse {

/// A table file.
struct TableFile {
  std::string name;         ///< of the file
  std::string header;       ///< names of the columns
  long lines_per_time = 1;  ///< added at every output time
};

/// The tables that a run of this case writes. `regions`: number of regions of the mesh.
std::vector<TableFile> table_files(const Scene& scene, std::size_t regions);

/// Boundaries in boundaries.csv, in its order: the scene's boundaries and wells, then the leaky
/// walls. Nothing crosses the rest of the outer boundary.
std::vector<std::string> booked_boundaries(const Scene& scene);

// The line of a row, with its end.
std::string table_line(const HistoryRow& row);
std::string table_line(const LedgerRow& row);
std::string table_line(const RegionRow& row);
std::string table_line(const BoundaryRow& row);
std::string table_line(const ProbeRow& row);
std::string table_line(const SectionRow& row);

/// A text as a cell of a CSV file: on one line, quoted if necessary.
std::string csv_cell(std::string text);
/// The cells of a line, which may begin with a byte order mark and end in a carriage return.
std::vector<std::string> csv_cells(std::string line);

}  // namespace suffuse
