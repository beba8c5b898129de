#pragma once

/// Writes the results folder of a run. Layout: docs/reference/file-formats.md.
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

/// Values of one field at one time, `components` per entity, entity by entity.
struct Field {
  std::string name;  ///< as in the symbol table of docs/theory/README.md
  std::string unit;
  int components = 1;
  std::vector<double> values;
  bool is_whole = false;  ///< whole numbers, which are never rounded to float32
};

/// The discharge of which least is known at one time.
struct DischargeRecord {
  double low = 0.0;   ///< m3/s
  double high = 0.0;  ///< m3/s
  /// No discharge of the model is larger by orders of magnitude, m3/s.
  double largest_flux = 0.0;
  std::string why_estimate;  ///< why the interval is no bound; empty where it is one
};

/// The model at one time.
struct Snapshot {
  double time = 0.0;
  long step = 0;
  std::vector<Field> cell;   ///< per element: means
  std::vector<Field> node;   ///< per mesh node
  std::vector<Field> solid;  ///< per solid point
  /// x, y, z of every solid point; empty if they are at rest.
  std::vector<double> solid_positions = {};
  std::vector<double> liquid_positions;  ///< x, y, z of every liquid point; double-point only
  std::vector<Field> liquid;             ///< per liquid point
  /// Linear field of each element at its vertices: Dim + 1 components, in the order of its nodes.
  /// `sample` reads these fields.
  std::vector<Field> element_vertex;
  /// Where mesh.error is given; the field `error` has the part of each element in half the
  /// interval.
  std::optional<DischargeRecord> discharge = {};
  /// The state from which a run can continue after this snapshot.
  std::optional<RestartPoint> restart;
};

/// run.json without the scene and the versions, which the writer adds.
struct RunInfo {
  std::string status = "running";  ///< "running", "done", "failed" or "interrupted"
  std::string message;             ///< why it failed, empty otherwise
  long steps = 0;
  long solid_points = 0;
  long liquid_points = 0;
  long elements = 0;
  int threads = 1;  ///< of each rank
  int ranks = 1;
  double wall_seconds = 0.0;  ///< of this process, like those of the passes
  /// Time from which the run was continued, s; nothing in a run from the start.
  std::optional<double> resumed_at;
  double memory_bytes = 0.0;  ///< largest resident set so far
  std::vector<PassTiming> passes;
  std::vector<std::string> plan;      ///< sentences: what runs, what is skipped and why
  std::vector<std::string> warnings;  ///< as printed
};

/// A table that only grows. Rows are flushed immediately; if the disk is full, the earlier rows
/// stay complete.
class GrowingTable {
 public:
  GrowingTable() = default;
  /// Creates a file with this line.
  GrowingTable(std::string path, const std::string& names);
  /// Continues after the first `rows` lines below the names; removes the others.
  GrowingTable(std::string path, long rows);
  /// Appends complete lines. Throws FileError, also if the file was replaced.
  void append(const std::string& lines);

 private:
  std::string path_;
  std::uintmax_t size_ = 0;  ///< of the file, bytes
  std::ofstream out_;
};

/// Owns the folder and keeps other solvers out. Rows are flushed immediately; a snapshot is written
/// under a temporary name, renamed, and then listed in the .series files. Throws FileError.
template <int Dim>
class ResultsWriter {
 public:
  /// Makes the folder, replaces an earlier run of the same case, and copies what a reader needs of
  /// the case. Throws as `lock_for_results` does.
  ResultsWriter(const std::string& folder, const Case<Dim>& c);
  /// Takes a folder whose lock is held; replaces any run.
  ResultsWriter(const std::string& folder, const Case<Dim>& c, FolderLock lock);
  /// Continues the run in the folder; removes results after `point`.
  ResultsWriter(const std::string& folder, const Case<Dim>& c, FolderLock lock,
                const RestartPoint& point);

  void append_history(const HistoryRow& row);
  void append_ledger(const LedgerRow& row);
  void append_regions(std::span<const RegionRow> rows);
  void append_boundaries(std::span<const BoundaryRow> rows);
  void append_probes(std::span<const ProbeRow> rows);
  void append_sections(std::span<const SectionRow> rows);
  /// Move the snapshot in if it has many points.
  void write_snapshot(Snapshot snapshot);
  /// Writes the state of a run that stops between snapshots or has long written none.
  void write_checkpoint(const RestartPoint& point);
  /// Call this before the status becomes "done".
  void remove_checkpoint();
  void write_run_info(const RunInfo& info);

 private:
  /// A .series file, which only grows.
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
  /// Appends lines to the table of this name.
  template <class Row>
  void append(const char* name, std::span<const Row> rows);

  std::string folder_;
  const Case<Dim>& case_;
  std::string model_digest_;  ///< of the case at construction; the case may lose its points later
  FolderLock lock_;
  std::vector<TableFile> files_;
  std::vector<GrowingTable> tables_;  ///< one for each of `files_`
  Series mesh_series_{"mesh", 0, ""};
  Series solid_series_{"solid", 0, ""};
  Series liquid_series_{"liquid", 0, ""};
};

}  // namespace suffuse
