#pragma once

/// Writes the results folder of a run. Layout: docs/file-formats.md.
///
///     NAME.results/run.json  history.csv  ledger.csv  regions.csv
///     NAME.results/mesh.hdf.series  solid.hdf.series  liquid.hdf.series
///     NAME.results/snapshots/mesh_000000.hdf  solid_000000.hdf  liquid_000000.hdf  ...

#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "results/tables.hpp"

namespace suffuse {

/// Values of one field at one moment, `components` per entity, entity by entity.
struct Field {
  std::string name;  ///< as in the symbol table of docs/theory.md
  std::string unit;
  int components = 1;
  std::vector<double> values;
};

/// The model at one time.
struct Snapshot {
  double time = 0.0;
  long step = 0;
  std::vector<Field> cell;               ///< per element: means
  std::vector<Field> node;               ///< per mesh node
  std::vector<Field> solid;              ///< per solid point
  std::vector<double> liquid_positions;  ///< x, y, z of every liquid point; double-point only
  std::vector<Field> liquid;             ///< per liquid point
  /// The element's own linear scalar at its vertices: Dim + 1 components per element, in the order
  /// of its nodes. `sample` reads these.
  std::vector<Field> element_vertex;
  /// What a resumed run needs, by name; shapes are the solver's business.
  std::vector<Field> restart;
};

/// What one pass of the solver cost.
struct PassTiming {
  std::string name;
  long calls = 0;
  double seconds = 0.0;
};

/// run.json, but for the scene and the versions, which the writer adds.
struct RunInfo {
  std::string status = "running";  ///< "running", "done", "failed" or "interrupted"
  std::string message;             ///< why it failed, empty otherwise
  long steps = 0;
  long solid_points = 0;
  long liquid_points = 0;
  long elements = 0;
  int threads = 1;
  double wall_seconds = 0.0;
  double memory_bytes = 0.0;  ///< largest resident set so far
  std::vector<PassTiming> passes;
  std::vector<std::string> plan;      ///< sentences: what runs, what is skipped and why
  std::vector<std::string> warnings;  ///< as printed
};

/// Owns the folder from construction on. Rows are flushed as they come; a snapshot is written under
/// a temporary name, renamed, and only then named in the .series files. Throws FileError.
template <int Dim>
class ResultsWriter {
 public:
  /// Makes the folder, replacing the run that stood there before (only when it is a results folder:
  /// anything else is refused), and copies what a reader needs of the case.
  ResultsWriter(const std::string& folder, const Case<Dim>& c);

  void append_history(const HistoryRow& row);
  void append_ledger(const LedgerRow& row);
  void append_regions(std::span<const RegionRow> rows);
  /// Hand it over where there are many points.
  void write_snapshot(Snapshot snapshot);
  void write_run_info(const RunInfo& info);

 private:
  /// A .series file, whose entries only become more.
  struct Series {
    std::string kind;
    std::size_t count = 0;
    std::string entries;  ///< as they stand in the file
  };
  void append_to(Series& series, const std::string& file, double time) const;

  std::string folder_;
  const Case<Dim>& case_;
  std::ofstream history_;
  std::ofstream ledger_;
  std::ofstream regions_;
  Series mesh_series_{"mesh", 0, ""};
  Series solid_series_{"solid", 0, ""};
  Series liquid_series_{"liquid", 0, ""};
};

}  // namespace suffuse
