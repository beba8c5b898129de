#include "case/mesh_io.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace suffuse {

void write_header(Hdf5File& file, const FileKind& kind, int dimension) {
  const auto integer = [&](const std::string& name, std::int64_t value) {
    file.attribute("/suffuse", name, std::span<const std::int64_t>(&value, 1));
  };
  file.create_group("/suffuse");
  file.attribute("/suffuse", "format", std::string(kind.format));
  file.attribute("/suffuse", "generator", std::string(kind.program) + ' ' + SUFFUSE_VERSION);
  integer("schema_version", kind.schema_version);
  integer("dimension", dimension);
}

int read_header(const Hdf5File& file, const FileKind& kind) {
  if (!file.exists("/suffuse") || !file.has_attribute("/suffuse", "format") ||
      file.text_attribute("/suffuse", "format") != kind.format) {
    throw FileError(file.path() + ": is not " + kind.name + "; expected what " + kind.command +
                    " writes");
  }
  const std::int64_t version = file.integer_attribute("/suffuse", "schema_version");
  if (version != kind.schema_version) {
    throw FileError(file.path() + ": is " + kind.name + " of schema version " +
                    std::to_string(version) + "; this program reads version " +
                    std::to_string(kind.schema_version) + ": write it anew with the " +
                    kind.program + " of this version");
  }
  const std::int64_t dimension = file.integer_attribute("/suffuse", "dimension");
  if (dimension != 2 && dimension != 3) {
    throw FileError(file.path() + ": its dimension is " + std::to_string(dimension) +
                    "; expected 2 or 3: write it anew with " + kind.command);
  }
  return static_cast<int>(dimension);
}

template <int Dim>
void write_elements(Hdf5File& file, const Mesh<Dim>& mesh) {
  file.write("/mesh/nodes", flattened<double>(mesh.nodes), {mesh.nodes.size(), std::size_t{Dim}});
  file.attribute("/mesh/nodes", "unit", std::string("m"));
  file.write("/mesh/elements", flattened<std::int32_t>(mesh.elements),
             {mesh.elements.size(), std::size_t{Dim + 1}});
  file.write("/mesh/element_region", std::span<const std::int32_t>(mesh.element_region),
             {mesh.element_region.size()});
  file.write_texts("/mesh/region_names", mesh.region_names);
}

template <int Dim>
Mesh<Dim> ElementReader<Dim>::read_elements() const {
  Mesh<Dim> mesh;
  read_nodes(mesh);
  read_regions(mesh);
  mesh.elements = read_rows<Dim + 1>("/mesh/elements", mesh.node_count());
  if (mesh.element_region.size() != mesh.elements.size()) {
    fail("/mesh/element_region", "expected one value per element");
  }
  check_elements(mesh);
  return mesh;
}

template <int Dim>
std::vector<int> ElementReader<Dim>::read_indices(const std::string& dataset, int limit) const {
  const std::vector<std::int64_t> wide = file_.read_integers(dataset);
  std::vector<int> indices(wide.size());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    if (wide[i] < 0 || wide[i] >= limit) {
      fail(dataset, "value " + std::to_string(i) + " is " + std::to_string(wide[i]) +
                        "; expected 0 to " + std::to_string(limit - 1));
    }
    indices[i] = static_cast<int>(wide[i]);
  }
  return indices;
}

template <int Dim>
void ElementReader<Dim>::read_nodes(Mesh<Dim>& mesh) const {
  const auto rows = this->template unflatten<Dim>("/mesh/nodes", file_.read_doubles("/mesh/nodes"));
  if (rows.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    fail("/mesh/nodes", "too many nodes");
  }
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (!std::ranges::all_of(rows[n], [](double x) { return std::isfinite(x); })) {
      fail("/mesh/nodes", "node " + std::to_string(n) + " is not finite");
    }
    mesh.nodes.push_back(Eigen::Map<const Vector<Dim>>(rows[n].data()));
  }
}

template <int Dim>
void ElementReader<Dim>::read_regions(Mesh<Dim>& mesh) const {
  mesh.region_names = file_.read_texts("/mesh/region_names");
  check_names("/mesh/region_names", mesh.region_names);
  mesh.element_region =
      read_indices("/mesh/element_region", static_cast<int>(mesh.region_names.size()));
}

template <int Dim>
void ElementReader<Dim>::check_elements(const Mesh<Dim>& mesh) const {
  if (mesh.elements.empty()) fail("/mesh/elements", "expected at least one element");
  std::vector<bool> node_used(mesh.nodes.size(), false);
  std::vector<bool> region_used(mesh.region_names.size(), false);
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int node : mesh.elements[e]) node_used[node] = true;
    region_used[mesh.element_region[e]] = true;
    if (!(element_volume(mesh, e) > 0.0)) {
      fail("/mesh/elements", "element " + std::to_string(e) + " has no positive volume");
    }
  }
  if (!std::ranges::all_of(node_used, std::identity())) {
    fail("/mesh/nodes", "a node belongs to no element");
  }
  if (!std::ranges::all_of(region_used, std::identity())) {
    fail("/mesh/region_names", "a region has no element");
  }
}

template void write_elements(Hdf5File&, const Mesh<2>&);
template void write_elements(Hdf5File&, const Mesh<3>&);
template class ElementReader<2>;
template class ElementReader<3>;

}  // namespace suffuse
