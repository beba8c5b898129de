#pragma once

/// Reads a results folder.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/hdf5_io.hpp"
#include "files/tables.hpp"
#include "mesh/mesh.hpp"
#include "results/writer.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// A numeric table of named columns with equal lengths.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  std::vector<std::string> units{};  ///< of each column, "" if not given; may be empty

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  /// Names with units, as files have them: "t [s]".
  [[nodiscard]] std::vector<std::string> headings() const;
  [[nodiscard]] bool has(const std::string& name) const;
  /// Throws FileError when there is no such column.
  [[nodiscard]] const std::vector<double>& column(const std::string& name) const;
};

/// Reads a CSV file of numbers with one line of names; `t [s]` is the
/// column t of unit s. Blank lines are left out. Throws FileError with file and line, InputError
/// for a column that is there twice.
Table read_table(const std::string& path);

/// The rows of a table with the same text in one column.
struct NamedTable {
  std::string name;  ///< the value
  Table table;       ///< the other columns
};
/// Reads a CSV file of numbers with one column of text, `by`: a table for each text, in the order
/// of their first rows. Throws FileError with file and line.
std::vector<NamedTable> read_tables(const std::string& path, const std::string& by);

/// Writes numbers exactly. `-` is standard output.
void write_table(const std::string& path, const Table& table);
/// Writes tables with equal columns row by row, with `by` as the second column.
void write_tables(const std::string& path, const std::string& by,
                  const std::vector<NamedTable>& tables);

/// A finished or running results folder.
class ResultsReader {
 public:
  /// Throws FileError when `folder` is not a results folder.
  explicit ResultsReader(const std::string& folder);

  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] const SceneDocument& scene() const { return scene_; }
  [[nodiscard]] const std::vector<std::string>& regions() const { return regions_; }
  /// Status at construction: "running", "done", "failed", "interrupted", or "stopped without
  /// notice": the run has no recorded end and no solver holds the folder, so it was killed or its
  /// machine stopped.
  [[nodiscard]] std::string status() const { return status_; }
  [[nodiscard]] int dimension() const { return dimension_; }

  [[nodiscard]] Table history() const;
  [[nodiscard]] Table ledger() const;
  [[nodiscard]] Table region_ledgers() const;
  /// One table for each boundary that has a condition.
  [[nodiscard]] std::vector<NamedTable> boundaries() const;
  /// Throws FileError if the scene has no probes; `sections` likewise.
  [[nodiscard]] Table probes() const;
  [[nodiscard]] Table sections() const;

  /// Times of the snapshots, ascending.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Path of snapshot `index` of "mesh", "solid" or "liquid".
  [[nodiscard]] std::string snapshot_path(const std::string& kind, std::size_t index) const;
  /// The mesh with its regions and boundaries. Throws InputError for results of another dimension,
  /// as `point_positions` does; `with_mesh` accepts both dimensions.
  template <int Dim = 2>
  [[nodiscard]] Mesh<Dim> mesh() const;
  /// Positions of the "solid" or "liquid" points of a snapshot.
  template <int Dim = 2>
  [[nodiscard]] std::vector<Vector<Dim>> point_positions(std::size_t index,
                                                         const std::string& kind) const;
  /// One field of a snapshot, with values for every element, node or point; `where` is "cell",
  /// "node", "solid", "liquid" or "element_vertex".
  [[nodiscard]] Field field(std::size_t index, const std::string& where,
                            const std::string& name) const;
  [[nodiscard]] std::vector<std::string> field_names(std::size_t index,
                                                     const std::string& where) const;
  /// What is known of the discharge at a snapshot; nothing without mesh.error.
  [[nodiscard]] std::optional<DischargeRecord> discharge(std::size_t index) const;

 private:
  /// Throws InputError for results of another dimension.
  void require_dimension(int dimension) const;
  /// Reads the files of one kind; drops snapshots that have no such file yet.
  void take_series(const std::string& kind, std::vector<std::string>& files);
  /// The file with an object of a snapshot: that of the snapshot, or that of the common grid. No
  /// other link is followed.
  [[nodiscard]] Hdf5File file_of(std::size_t index, const std::string& where,
                                 const std::string& object) const;
  /// Number of elements, nodes or points with values in a snapshot.
  [[nodiscard]] std::size_t entity_count(std::size_t index, const std::string& where) const;

  std::string folder_;
  SceneDocument scene_;
  std::vector<std::string> regions_;
  std::string status_;
  int dimension_ = 2;
  std::vector<double> times_;
  std::vector<std::string> mesh_files_;
  std::vector<std::string> solid_files_;
  std::vector<std::string> liquid_files_;  ///< none in single-point runs
};

/// Calls `use` with the mesh, a Mesh<2> or a Mesh<3>.
template <class Use>
auto with_mesh(const ResultsReader& results, const Use& use) {
  return results.dimension() == 3 ? use(results.mesh<3>()) : use(results.mesh<2>());
}

}  // namespace suffuse
