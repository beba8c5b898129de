#pragma once

/// What the files of this library share: their header, and the elements of a mesh in HDF5.

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/errors.hpp"
#include "common/hdf5_io.hpp"
#include "mesh/mesh.hpp"

namespace suffuse {

/// A kind of file, as its header and the messages about it name it.
struct FileKind {
  const char* format;           ///< attribute of the header
  const char* name;             ///< with its article
  const char* program;          ///< that writes it
  const char* command;          ///< the program with the option that has it write the file
  std::int64_t schema_version;  ///< that this program reads and writes
};

void write_header(Hdf5File& file, const FileKind& kind, int dimension);

/// The dimension of the file's mesh. Throws FileError for a file of another kind or version.
int read_header(const Hdf5File& file, const FileKind& kind);

/// Writes nodes, elements and regions of a mesh, without its boundaries.
template <int Dim>
void write_elements(Hdf5File& file, const Mesh<Dim>& mesh);

/// All rows one after the other.
template <class Value, class Rows>
std::vector<Value> flattened(const Rows& rows) {
  std::vector<Value> flat;
  for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  return flat;
}

/// Reads the elements of a mesh, and tables in general. Every error names the file and the object.
template <int Dim>
class ElementReader {
 public:
  /// \param remedy  ends every message: what the user can do
  ElementReader(const Hdf5File& file, std::string remedy)
      : file_(file), remedy_(std::move(remedy)) {}

  /// Nodes, elements and regions, without boundaries. Throws FileError where they are not those of
  /// a mesh.
  [[nodiscard]] Mesh<Dim> read_elements() const;

  [[noreturn]] void fail(const std::string& object, const std::string& what) const {
    throw FileError(file_.path() + ": " + object + ": " + what + "; " + remedy_);
  }

 protected:
  template <std::size_t Columns, class Value>
  [[nodiscard]] std::vector<std::array<Value, Columns>> unflatten(
      const std::string& dataset, const std::vector<Value>& flat) const {
    const std::vector<std::size_t> shape = file_.shape(dataset);
    if (shape.size() != 2 || shape[1] != Columns) {
      fail(dataset, "expected a table of " + std::to_string(Columns) + " columns");
    }
    std::vector<std::array<Value, Columns>> rows(shape[0]);
    for (std::size_t i = 0; i < flat.size(); ++i) rows[i / Columns][i % Columns] = flat[i];
    return rows;
  }

  /// Reads integers, each in [0, limit).
  [[nodiscard]] std::vector<int> read_indices(const std::string& dataset, int limit) const;

  template <std::size_t Columns>
  [[nodiscard]] std::vector<std::array<int, Columns>> read_rows(const std::string& dataset,
                                                                int limit) const {
    return unflatten<Columns>(dataset, read_indices(dataset, limit));
  }

  void check_names(const std::string& object, const std::vector<std::string>& names) const {
    const std::set<std::string> unique(names.begin(), names.end());
    if (unique.size() != names.size() || unique.contains("")) {
      fail(object, "expected names that differ and are not empty");
    }
  }

  const Hdf5File& file_;

 private:
  void read_nodes(Mesh<Dim>& mesh) const;
  void read_regions(Mesh<Dim>& mesh) const;
  void check_elements(const Mesh<Dim>& mesh) const;

  std::string remedy_;
};

}  // namespace suffuse
