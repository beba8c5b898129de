#include "case/mesh_sizes.hpp"

#include <cmath>
#include <stdexcept>

#include "case/mesh_io.hpp"
#include "common/pending_file.hpp"

namespace suffuse {

namespace {

constexpr FileKind sizes_file{"suffuse-sizes", "a file of sizes", "suffuse-solver",
                              "suffuse-solver --sizes", 1};

constexpr const char* size_table = "/size";

}  // namespace

template <int Dim>
void write_mesh_sizes(const std::string& path, const Mesh<Dim>& mesh,
                      const std::vector<double>& size) {
  if (size.size() != mesh.nodes.size()) throw std::logic_error("expected one size per node");
  PendingFile pending(path);
  Hdf5File file(pending.temporary_path(), Hdf5File::Mode::create);
  write_header(file, sizes_file, Dim);
  write_elements(file, mesh);
  file.write(size_table, size, {size.size()});
  file.attribute(size_table, "unit", std::string("m"));
  file.close();
  pending.commit();
}

template <int Dim>
MeshSizes<Dim> read_mesh_sizes(const std::string& path) {
  const Hdf5File file(path, Hdf5File::Mode::read);
  const int dimension = read_header(file, sizes_file);
  if (dimension != Dim) {
    throw FileError(path + ": has sizes of dimension " + std::to_string(dimension) + "; expected " +
                    std::to_string(Dim));
  }
  const ElementReader<Dim> reader(file, "write it anew with suffuse-solver --sizes");
  MeshSizes<Dim> sizes{reader.read_elements(), file.read_doubles(size_table)};
  if (sizes.size.size() != sizes.mesh.nodes.size()) {
    reader.fail(size_table, "expected one value per node");
  }
  for (std::size_t n = 0; n < sizes.size.size(); ++n) {
    if (std::isfinite(sizes.size[n]) && sizes.size[n] > 0.0) continue;
    reader.fail(size_table,
                "the size at node " + std::to_string(n) + " is not positive and finite");
  }
  return sizes;
}

int read_mesh_sizes_dimension(const std::string& path) {
  return read_header(Hdf5File(path, Hdf5File::Mode::read), sizes_file);
}

template void write_mesh_sizes(const std::string&, const Mesh<2>&, const std::vector<double>&);
template void write_mesh_sizes(const std::string&, const Mesh<3>&, const std::vector<double>&);
template MeshSizes<2> read_mesh_sizes(const std::string&);
template MeshSizes<3> read_mesh_sizes(const std::string&);

}  // namespace suffuse
