#include "column.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace suffuse {

namespace geo = gmsh::model::geo;

namespace {

/// A horizontal line of the column with its ends.
struct Level {
  int left;
  int right;
  int line;
};

Level add_level(double y, double width, double size, int columns, bool regular) {
  Level level{};
  level.left = geo::addPoint(0.0, y, 0.0, size);
  level.right = geo::addPoint(width, y, 0.0, size);
  level.line = geo::addLine(level.left, level.right);
  if (regular) geo::mesh::setTransfiniteCurve(level.line, columns + 1);
  return level;
}

void name_group(int dimension, const std::vector<int>& entities, const std::string& name) {
  const int group = gmsh::model::addPhysicalGroup(dimension, entities);
  gmsh::model::setPhysicalName(dimension, group, name);
}

}  // namespace

ColumnShape column_of(const Scene& scene) {
  return {scene.geometry.width, {{"specimen", 0.0, scene.geometry.height}}};
}

int element_rows(double length, double size) {
  return std::max(1, static_cast<int>(std::lround(length / size)));
}

void mesh_column(const ColumnShape& column, const MeshSettings& settings) {
  const bool regular = settings.structure == MeshStructure::regular;
  const int columns = element_rows(column.width, settings.size);
  gmsh::model::add("column");
  gmsh::option::setNumber("Mesh.MeshSizeMax", settings.size);

  Level below =
      add_level(column.layers.front().bottom, column.width, settings.size, columns, regular);
  const int bottom = below.line;
  std::vector<int> left;
  std::vector<int> right;
  std::map<std::string, std::vector<int>> regions;
  for (const ColumnLayer& layer : column.layers) {
    const Level above = add_level(layer.top, column.width, settings.size, columns, regular);
    right.push_back(geo::addLine(below.right, above.right));
    left.push_back(geo::addLine(above.left, below.left));
    const int loop = geo::addCurveLoop({below.line, right.back(), -above.line, left.back()});
    const int surface = geo::addPlaneSurface({loop});
    if (regular) {
      const int rows = element_rows(layer.top - layer.bottom, settings.size);
      geo::mesh::setTransfiniteCurve(left.back(), rows + 1);
      geo::mesh::setTransfiniteCurve(right.back(), rows + 1);
      geo::mesh::setTransfiniteSurface(surface, "Left",
                                       {below.left, below.right, above.right, above.left});
    }
    regions[layer.region].push_back(surface);
    below = above;
  }
  geo::synchronize();
  for (const auto& [region, surfaces] : regions) name_group(2, surfaces, region);
  name_group(1, {below.line}, "top");
  name_group(1, {bottom}, "bottom");
  name_group(1, left, "left");
  name_group(1, right, "right");
  gmsh::model::mesh::generate(2);
}

}  // namespace suffuse
