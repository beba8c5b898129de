#include "gmsh_export.hpp"

#include <gmsh.h>

#include <array>
#include <fstream>
#include <numeric>

#include "common/errors.hpp"
#include "common/pending_file.hpp"
#include "gmsh_groups.hpp"
#include "gmsh_session.hpp"
#include "gmsh_types.hpp"

namespace suffuse {

namespace {

/// Okabe and Ito's colours, which the colour-blind can distinguish.
constexpr std::array<std::array<int, 3>, 7> palette{{{230, 159, 0},
                                                     {86, 180, 233},
                                                     {0, 158, 115},
                                                     {240, 228, 66},
                                                     {0, 114, 178},
                                                     {213, 94, 0},
                                                     {204, 121, 167}}};

/// Gmsh counts from one. Nodes belong to an entity: the first region has all of them.
template <int Dim>
void add_nodes(const Mesh<Dim>& mesh) {
  std::vector<std::size_t> tags(mesh.nodes.size());
  std::iota(tags.begin(), tags.end(), 1U);
  std::vector<double> coordinates;
  for (const Vector<Dim>& x : mesh.nodes) {
    coordinates.insert(coordinates.end(), {x[0], x[1], Dim == 2 ? 0.0 : x[Dim - 1]});
  }
  gmsh::model::mesh::addNodes(Dim, 1, tags, coordinates);
}

template <int Dim>
void add_regions(const Mesh<Dim>& mesh) {
  const int count = static_cast<int>(mesh.region_names.size());
  std::vector<std::vector<std::size_t>> tags(mesh.region_names.size());
  std::vector<std::vector<std::size_t>> nodes(mesh.region_names.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int region = mesh.element_region[e];
    tags[region].push_back(static_cast<std::size_t>(e) + 1);
    for (int node : mesh.elements[e]) nodes[region].push_back(static_cast<std::size_t>(node) + 1);
  }
  for (int r = 0; r < count; ++r) gmsh::model::addDiscreteEntity(Dim, r + 1);
  add_nodes(mesh);
  for (int r = 0; r < count; ++r) {
    gmsh::model::mesh::addElementsByType(
        r + 1, Dim == 2 ? gmsh_type::triangle : gmsh_type::tetrahedron, tags[r], nodes[r]);
    name_group(Dim, {r + 1}, mesh.region_names[r], r + 1);
  }
}

template <int Dim>
void add_boundaries(const Mesh<Dim>& mesh) {
  auto next_tag = static_cast<std::size_t>(mesh.element_count()) + 1;
  int entity = 0;
  for (const BoundarySet<Dim>& set : mesh.boundaries) {
    gmsh::model::addDiscreteEntity(Dim - 1, ++entity);
    std::vector<std::size_t> tags;
    std::vector<std::size_t> nodes;
    for (const auto& face : set.faces) {
      tags.push_back(next_tag++);
      for (int node : face) nodes.push_back(static_cast<std::size_t>(node) + 1);
    }
    gmsh::model::mesh::addElementsByType(entity, Dim == 2 ? gmsh_type::line : gmsh_type::triangle,
                                         tags, nodes);
    name_group(Dim - 1, {entity}, set.name, entity);
  }
}

template <int Dim>
void write_options(const std::string& path, const Mesh<Dim>& mesh) {
  PendingFile pending(path);
  std::ofstream stream(pending.temporary_path());
  stream << (Dim == 2 ? "Mesh.SurfaceFaces" : "Mesh.VolumeEdges")
         << " = 1;\nMesh.ColorCarousel = 2;\n";
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) {
    const auto& colour = palette[r % palette.size()];
    stream << "Color {" << colour[0] << ", " << colour[1] << ", " << colour[2] << "} { "
           << (Dim == 2 ? "Surface" : "Volume") << " {" << r + 1 << "}; }\n";
  }
  stream.close();
  if (!stream) throw FileError(path + ": could not be written; is the disk full?");
  pending.commit();
}

}  // namespace

template <int Dim>
void write_gmsh(const std::string& path, const Mesh<Dim>& mesh) {
  PendingFile pending(path);
  {
    const GmshSession session;
    const std::string complaint = gmsh_complaint([&] {
      gmsh::model::add("suffuse");
      add_regions(mesh);
      add_boundaries(mesh);
      gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
      gmsh::write(pending.temporary_path());
    });
    if (!complaint.empty()) throw FileError(path + ": could not be written: " + complaint);
  }
  pending.commit();
  write_options(path + ".opt", mesh);
}

template void write_gmsh(const std::string&, const Mesh<2>&);
template void write_gmsh(const std::string&, const Mesh<3>&);

}  // namespace suffuse
