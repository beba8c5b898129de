#pragma once

/// Writes the results folder of a run. Layout: docs/file-formats.md.
///
///     NAME.results/run.json  history.csv  ledger.csv  regions.csv  boundaries.csv
///     NAME.results/probes.csv  sections.csv   where the scene has any
///     NAME.results/mesh.hdf.series  solid.hdf.series  liquid.hdf.series
///     NAME.results/snapshots/mesh_grid.hdf    solid_grid.hdf
///     NAME.results/snapshots/mesh_000000.hdf  solid_000000.hdf  liquid_000000.hdf  ...
///     NAME.results/snapshots/state_000010.hdf  of the newest snapshots
///     NAME.results/checkpoint.hdf             where a run was stopped between snapshots

#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "files/folder_lock.hpp"
#include "files/table_files.hpp"
#include "results/earlier_run.hpp"
#include "results/pass_timer.hpp"
#include "results/restart_point.hpp"

namespace suffuse {

/// Values of one field at one moment, `components` per entity, entity by entity.
struct Field {
  std::string name;  ///< as in the symbol table of docs/theory.md
  std::string unit;
  int components = 1;
  std::vector<double> values;
  bool is_whole = false;  ///< numbers of things, which are never rounded to float32
};

/// The model at one time.
struct Snapshot {
  double time = 0.0;
  long step = 0;
  std::vector<Field> cell;   ///< per element: means
  std::vector<Field> node;   ///< per mesh node
  std::vector<Field> solid;  ///< per solid point
  /// x, y, z of every solid point; empty where they stay where the case has them.
  std::vector<double> solid_positions = {};
  std::vector<double> liquid_positions;  ///< x, y, z of every liquid point; double-point only
  std::vector<Field> liquid;             ///< per liquid point
  /// The element's own linear scalar at its vertices: Dim + 1 components per element, in the order
  /// of its nodes. `sample` reads these.
  std::vector<Field> element_vertex;
  /// The state from which a run can continue after this snapshot.
  std::optional<RestartPoint> restart;
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
  double wall_seconds = 0.0;  ///< of this process, as those of the passes
  /// s; nothing in a run from the start
  std::optional<double> resumed_at;
  double memory_bytes = 0.0;  ///< largest resident set so far
  std::vector<PassTiming> passes;
  std::vector<std::string> plan;      ///< sentences: what runs, what is skipped and why
  std::vector<std::string> warnings;  ///< as printed
};

/// A table that only grows. Rows are flushed as they come; one that does not fit on the disk leaves
/// those before it as they are.
class GrowingTable {
 public:
  GrowingTable() = default;
  /// A new file with this line.
  GrowingTable(std::string path, const std::string& names);
  /// Goes on behind the first `rows` lines after the names; drops the others.
  GrowingTable(std::string path, long rows);
  /// Whole lines. Throws FileError, also where the file is no longer the one that was written to.
  void append(const std::string& lines);

 private:
  std::string path_;
  std::uintmax_t size_ = 0;  ///< of the file, bytes
  std::ofstream out_;
};

/// Owns the folder from construction on, and lets no other solver in. Rows are flushed as they
/// come; a snapshot is written under a temporary name, renamed, and only then named in the .series
/// files. Throws FileError.
template <int Dim>
class ResultsWriter {
 public:
  /// Makes the folder, replacing a run of the same case that stood there before, and copies what a
  /// reader needs of the case. Throws as `lock_for_results` does.
  ResultsWriter(const std::string& folder, const Case<Dim>& c);
  /// Makes the folder with the lock in hand, replacing any run.
  ResultsWriter(const std::string& folder, const Case<Dim>& c, FolderLock lock);
  /// Goes on with the run that stands there: drops what came after `point`.
  ResultsWriter(const std::string& folder, const Case<Dim>& c, FolderLock lock,
                const RestartPoint& point);

  void append_history(const HistoryRow& row);
  void append_ledger(const LedgerRow& row);
  void append_regions(std::span<const RegionRow> rows);
  void append_boundaries(std::span<const BoundaryRow> rows);
  void append_probes(std::span<const ProbeRow> rows);
  void append_sections(std::span<const SectionRow> rows);
  /// Hand it over where there are many points.
  void write_snapshot(Snapshot snapshot);
  /// Where a run stops between snapshots, or would lose much if it were stopped.
  void write_checkpoint(const RestartPoint& point);
  /// When the run is about to be done.
  void remove_checkpoint();
  void write_run_info(const RunInfo& info);

 private:
  /// A .series file, whose entries only become more.
  struct Series {
    std::string kind;
    std::size_t count = 0;
    std::string entries;  ///< as they stand in the file
  };
  static void extend(Series& series, const std::string& file, double time);
  void write_series(const Series& series) const;
  void continue_series(Series& series, long snapshots);
  /// The files that all snapshots link to.
  void write_grids() const;
  /// Removes the states of snapshots that are no longer among the newest `output.restarts`.
  void remove_old_states() const;
  /// Lines of the table of this name.
  template <class Row>
  void append(const char* name, std::span<const Row> rows);

  std::string folder_;
  const Case<Dim>& case_;
  std::string model_digest_;  ///< of the case as it was at construction: it may lose its points
  FolderLock lock_;
  std::vector<TableFile> files_;
  std::vector<GrowingTable> tables_;  ///< one for each of `files_`
  Series mesh_series_{"mesh", 0, ""};
  Series solid_series_{"solid", 0, ""};
  Series liquid_series_{"liquid", 0, ""};
};

}  // namespace suffuse
