#include "gmsh_model.hpp"

#include <gmsh.h>

#include <algorithm>
#include <limits>

#include "gmsh_types.hpp"

namespace suffuse {

namespace {

std::vector<GmshElements> elements_of(int dimension, int entity) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
  std::vector<GmshElements> blocks;
  for (std::size_t t = 0; t < types.size(); ++t) {
    if (tags[t].empty()) continue;
    GmshElements& block = blocks.emplace_back();
    block.type = types[t];
    int own_dimension = 0;
    int order = 0;
    int primary_nodes = 0;
    std::vector<double> coordinates;
    gmsh::model::mesh::getElementProperties(block.type, block.type_name, own_dimension, order,
                                            block.nodes_each, coordinates, primary_nodes);
    block.nodes_each = static_cast<int>(nodes[t].size() / tags[t].size());
    block.tags = std::move(tags[t]);
    block.nodes = std::move(nodes[t]);
  }
  return blocks;
}

void add_entities(GmshModel& model, int dimension) {
  gmsh::vectorpair pairs;
  gmsh::model::getEntities(pairs, dimension);
  for (const auto& [ignored, tag] : pairs) {
    GmshEntity entity{dimension, tag, {}, elements_of(dimension, tag)};
    std::array<double, 6>& box = entity.box;
    // Gmsh has no bounding box for an entity without elements.
    if (!entity.elements.empty())
      gmsh::model::getBoundingBox(dimension, tag, box[0], box[1], box[2], box[3], box[4], box[5]);
    model.entities.push_back(std::move(entity));
  }
}

void add_groups(GmshModel& model, int dimension) {
  gmsh::vectorpair pairs;
  gmsh::model::getPhysicalGroups(pairs, dimension);
  for (const auto& [ignored, tag] : pairs) {
    GmshGroup group{dimension, tag, "", {}, {}};
    gmsh::model::getPhysicalName(dimension, tag, group.name);
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, group.entities);
    if (dimension == 0) {
      std::vector<double> coordinates;
      gmsh::model::mesh::getNodesForPhysicalGroup(0, tag, group.nodes, coordinates);
    }
    model.groups.push_back(std::move(group));
  }
}

/// Number of nodes of an element of a type that Suffuse reads; for other types the present number.
int expected_nodes(const GmshElements& block) {
  switch (block.type) {
    case gmsh_type::line:
      return 2;
    case gmsh_type::triangle:
      return 3;
    case gmsh_type::quadrangle:
    case gmsh_type::tetrahedron:
      return 4;
    default:
      return block.nodes_each;
  }
}

}  // namespace

int gmsh_model_dimension() {
  gmsh::vectorpair volumes;
  gmsh::model::getEntities(volumes, 3);
  return volumes.empty() ? 2 : 3;
}

GmshModel read_gmsh_model() {
  GmshModel model;
  model.dimension = gmsh_model_dimension();
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(model.node_tags, model.coordinates, parameters);
  for (const int dimension : {model.dimension, model.dimension - 1}) {
    add_entities(model, dimension);
    add_groups(model, dimension);
  }
  add_groups(model, 0);
  return model;
}

std::string gmsh_model_defect(const GmshModel& model) {
  const std::size_t count = model.node_tags.size();
  constexpr std::size_t most = std::numeric_limits<int>::max();  // indices of a mesh are of int
  if (model.dimension != 2 && model.dimension != 3) return "a model of no dimension";
  if (count > most || model.coordinates.size() != 3 * count) return "nodes without coordinates";
  std::vector<std::size_t> known = model.node_tags;
  if (!std::ranges::is_sorted(known)) std::ranges::sort(known);
  const bool in_a_row = !known.empty() && known.back() - known.front() == count - 1 &&
                        std::ranges::adjacent_find(known) == known.end();
  const auto is_known = [&](std::size_t node) {
    if (known.empty() || node < known.front() || node > known.back()) return false;
    return in_a_row || std::ranges::binary_search(known, node);
  };
  std::size_t elements = 0;
  for (const GmshEntity& entity : model.entities) {
    if (entity.dimension != model.dimension && entity.dimension != model.dimension - 1) {
      return "an entity of another dimension";
    }
    for (const GmshElements& block : entity.elements) {
      elements += block.tags.size();
      const bool matches =
          block.nodes_each > 0 && block.nodes_each == expected_nodes(block) &&
          block.nodes.size() % static_cast<std::size_t>(block.nodes_each) == 0 &&
          block.nodes.size() / static_cast<std::size_t>(block.nodes_each) == block.tags.size();
      // A quadrangle can become four triangles.
      if (!matches || elements > most / 4) return "elements without their nodes";
      if (!std::ranges::all_of(block.nodes, is_known)) return "elements at unknown nodes";
    }
  }
  return "";
}

}  // namespace suffuse
