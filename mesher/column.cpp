#include "column.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gmsh_groups.hpp"

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

/// The nearest multiple of length / rows.
double grid_position(double length, double at, int rows) {
  const auto row = static_cast<double>(std::lround(at / length * rows));
  return length * row / rows;
}

/// Corrects nodes: Gmsh places points of a transfinite curve to about 1e-12, balances need less.
void place_nodes_exactly(const ColumnShape& column, double size) {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  const int columns = element_rows(column.width, size);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const double x = grid_position(column.width, coordinates[3 * i], columns);
    const double y = grid_position(column.height, coordinates[3 * i + 1], column.rows);
    gmsh::model::mesh::setNode(tags[i], {x, y, 0.0}, {});
  }
}

}  // namespace

ColumnShape column_of(const Scene& scene) {
  const GeometrySettings& geometry = scene.geometry;
  const LayerSettings& rows = geometry.layers;
  ColumnShape column{geometry.width,
                     geometry.height,
                     element_rows(geometry.height, scene.mesh.size),
                     {},
                     rows.outflow > 0 ? "outflow" : "bottom",
                     rows.inflow > 0 ? "inflow" : "top"};
  const std::vector<std::pair<std::string, int>> upwards{
      {"outflow", rows.outflow}, {"free_below", rows.free_below}, {"buffer", rows.below},
      {"specimen", column.rows}, {"buffer", rows.above},          {"free_above", rows.free_above},
      {"inflow", rows.inflow}};
  int bottom = -(rows.outflow + rows.free_below + rows.below);
  for (const auto& [region, count] : upwards) {
    if (count > 0) column.layers.push_back({region, bottom, bottom + count});
    bottom += count;
  }
  return column;
}

int element_rows(double length, double size) {
  return std::max(1, static_cast<int>(std::lround(length / size)));
}

void mesh_column(const ColumnShape& column, const MeshSettings& settings) {
  const bool regular = settings.structure != MeshStructure::free;
  const int columns = element_rows(column.width, settings.size);
  gmsh::model::add("column");

  Level below = add_level(column.level(column.layers.front().bottom), column.width, settings.size,
                          columns, regular);
  const int bottom = below.line;
  std::vector<int> left;
  std::vector<int> right;
  std::vector<std::pair<std::string, std::vector<int>>> regions;  // bottom to top
  for (const ColumnLayer& layer : column.layers) {
    const Level above =
        add_level(column.level(layer.top), column.width, settings.size, columns, regular);
    right.push_back(geo::addLine(below.right, above.right));
    left.push_back(geo::addLine(above.left, below.left));
    const int loop = geo::addCurveLoop({below.line, right.back(), -above.line, left.back()});
    const int surface = geo::addPlaneSurface({loop});
    if (regular) {
      const int rows = layer.top - layer.bottom;
      geo::mesh::setTransfiniteCurve(left.back(), rows + 1);
      geo::mesh::setTransfiniteCurve(right.back(), rows + 1);
      geo::mesh::setTransfiniteSurface(surface, "Left",
                                       {below.left, below.right, above.right, above.left});
      if (settings.structure == MeshStructure::crossed) geo::mesh::setRecombine(2, surface);
    }
    auto region = std::ranges::find(regions, layer.region, [](const auto& r) { return r.first; });
    if (region == regions.end()) region = regions.insert(region, {layer.region, {}});
    region->second.push_back(surface);
    below = above;
  }
  geo::synchronize();
  for (const auto& [region, surfaces] : regions) name_group(2, surfaces, region);
  name_group(1, {below.line}, column.upper_boundary);
  name_group(1, {bottom}, column.lower_boundary);
  name_group(1, left, "left");
  name_group(1, right, "right");
  gmsh::model::mesh::generate(2);
  if (regular) place_nodes_exactly(column, settings.size);
}

}  // namespace suffuse
