#include "gmsh_export.hpp"

#include <gmsh.h>

#include <array>
#include <fstream>
#include <numeric>

#include "case/errors.hpp"
#include "case/pending_file.hpp"
#include "gmsh_session.hpp"
#include "gmsh_types.hpp"

namespace suffuse {

namespace {

/// Okabe and Ito's colours, told apart by the colour-blind too.
constexpr std::array<std::array<int, 3>, 7> palette{{{230, 159, 0},
                                                     {86, 180, 233},
                                                     {0, 158, 115},
                                                     {240, 228, 66},
                                                     {0, 114, 178},
                                                     {213, 94, 0},
                                                     {204, 121, 167}}};

void name_group(int dimension, int entity, const std::string& name) {
  const int group = gmsh::model::addPhysicalGroup(dimension, {entity}, entity);
  gmsh::model::setPhysicalName(dimension, group, name);
}

/// Gmsh counts from one. Nodes hang on an entity: the first region has them all.
void add_nodes(const Mesh<2>& mesh) {
  std::vector<std::size_t> tags(mesh.nodes.size());
  std::iota(tags.begin(), tags.end(), 1U);
  std::vector<double> coordinates;
  for (const Vector<2>& x : mesh.nodes) {
    coordinates.insert(coordinates.end(), {x[0], x[1], 0.0});
  }
  gmsh::model::mesh::addNodes(2, 1, tags, coordinates);
}

void add_regions(const Mesh<2>& mesh) {
  const int count = static_cast<int>(mesh.region_names.size());
  std::vector<std::vector<std::size_t>> tags(mesh.region_names.size());
  std::vector<std::vector<std::size_t>> nodes(mesh.region_names.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int region = mesh.element_region[e];
    tags[region].push_back(static_cast<std::size_t>(e) + 1);
    for (int node : mesh.elements[e]) nodes[region].push_back(static_cast<std::size_t>(node) + 1);
  }
  for (int r = 0; r < count; ++r) gmsh::model::addDiscreteEntity(2, r + 1);
  add_nodes(mesh);
  for (int r = 0; r < count; ++r) {
    gmsh::model::mesh::addElementsByType(r + 1, gmsh_type::triangle, tags[r], nodes[r]);
    name_group(2, r + 1, mesh.region_names[r]);
  }
}

void add_boundaries(const Mesh<2>& mesh) {
  auto next_tag = static_cast<std::size_t>(mesh.element_count()) + 1;
  int entity = 0;
  for (const BoundarySet<2>& set : mesh.boundaries) {
    gmsh::model::addDiscreteEntity(1, ++entity);
    std::vector<std::size_t> tags;
    std::vector<std::size_t> nodes;
    for (const auto& face : set.faces) {
      tags.push_back(next_tag++);
      for (int node : face) nodes.push_back(static_cast<std::size_t>(node) + 1);
    }
    gmsh::model::mesh::addElementsByType(entity, gmsh_type::line, tags, nodes);
    name_group(1, entity, set.name);
  }
}

void write_options(const std::string& path, const Mesh<2>& mesh) {
  PendingFile pending(path);
  std::ofstream stream(pending.temporary_path());
  stream << "Mesh.SurfaceFaces = 1;\nMesh.ColorCarousel = 2;\n";
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) {
    const auto& colour = palette[r % palette.size()];
    stream << "Color {" << colour[0] << ", " << colour[1] << ", " << colour[2] << "} { Surface {"
           << r + 1 << "}; }\n";
  }
  stream.close();
  if (!stream) throw FileError(path + ": could not be written; is the disk full?");
  pending.commit();
}

}  // namespace

void write_gmsh(const std::string& path, const Mesh<2>& mesh) {
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

}  // namespace suffuse
