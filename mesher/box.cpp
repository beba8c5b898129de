#include "box.hpp"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gmsh_groups.hpp"

namespace suffuse {

namespace geo = gmsh::model::geo;

namespace {

using Index = std::array<int, 3>;

template <class Visit>
void for_each(const Index& counts, const Visit& visit) {
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) visit(Index{i, j, k});
    }
  }
}

class RegularBox {
 public:
  RegularBox(const ColumnShape& column, double depth, double size)
      : column_(column),
        depth_(depth),
        bottom_(column.layers.front().bottom),
        cells_{element_rows(column.width, size), element_rows(depth, size),
               column.layers.back().top - bottom_} {}

  Mesh<3> run() {
    add_nodes();
    mesh_.boundaries = {{"left", {}},
                        {"right", {}},
                        {"front", {}},
                        {"back", {}},
                        {column_.lower_boundary, {}},
                        {column_.upper_boundary, {}}};
    const std::vector<int> regions = region_of_row();
    for_each(cells_, [&](const Index& cell) { add_cuboid(cell, regions[cell[2]]); });
    return std::move(mesh_);
  }

 private:
  void add_nodes() {
    for_each({cells_[0] + 1, cells_[1] + 1, cells_[2] + 1}, [&](const Index& at) {
      mesh_.nodes.emplace_back(column_.width * at[0] / cells_[0], depth_ * at[1] / cells_[1],
                               column_.level(bottom_ + at[2]));
    });
  }

  [[nodiscard]] int node(const Index& at) const {
    return (at[2] * (cells_[1] + 1) + at[1]) * (cells_[0] + 1) + at[0];
  }

  std::vector<int> region_of_row() {
    std::vector<int> regions;
    auto& names = mesh_.region_names;
    for (const ColumnLayer& layer : column_.layers) {
      auto name = std::ranges::find(names, layer.region);
      if (name == names.end()) name = names.insert(name, layer.region);
      regions.insert(regions.end(), layer.top - layer.bottom,
                     static_cast<int>(name - names.begin()));
    }
    return regions;
  }

  void add_cuboid(const Index& cell, int region) {
    Index axes{0, 1, 2};
    do {
      std::array<Index, 4> corners{cell, cell, cell, cell};
      for (int step = 0; step < 3; ++step) {
        for (int later = step + 1; later < 4; ++later) ++corners[later][axes[step]];
      }
      const bool even = (axes[1] + 3 - axes[0]) % 3 == 1;
      if (!even) std::swap(corners[2], corners[3]);
      mesh_.elements.push_back(
          {node(corners[0]), node(corners[1]), node(corners[2]), node(corners[3])});
      mesh_.element_region.push_back(region);
      add_outer_faces(corners);
    } while (std::ranges::next_permutation(axes).found);
  }

  /// Adds the faces that lie on a boundary with all three corners.
  void add_outer_faces(const std::array<Index, 4>& corners) {
    for (int d = 0; d < 3; ++d) {
      for (const int end : {0, 1}) {
        std::vector<int> face;
        for (const Index& corner : corners) {
          if (corner[d] == end * cells_[d]) face.push_back(node(corner));
        }
        if (face.size() == 3)
          mesh_.boundaries[2 * d + end].faces.push_back({face[0], face[1], face[2]});
      }
    }
  }

  const ColumnShape& column_;
  double depth_;
  int bottom_;  ///< lowest row of elements
  Index cells_;
  Mesh<3> mesh_;
};

/// Adds the rectangle at the bottom.
int add_floor(const ColumnShape& column, double depth, double size) {
  const double z = column.level(column.layers.front().bottom);
  const double w = column.width;
  const std::array<int, 4> points{geo::addPoint(0.0, 0.0, z, size), geo::addPoint(w, 0.0, z, size),
                                  geo::addPoint(w, depth, z, size),
                                  geo::addPoint(0.0, depth, z, size)};
  std::vector<int> lines;
  lines.reserve(points.size());
  for (int i = 0; i < 4; ++i) lines.push_back(geo::addLine(points[i], points[(i + 1) % 4]));
  return geo::addPlaneSurface({geo::addCurveLoop(lines)});
}

}  // namespace

Mesh<3> regular_box(const ColumnShape& column, double depth, double size) {
  return RegularBox(column, depth, size).run();
}

void mesh_free_box(const ColumnShape& column, double depth, double size) {
  gmsh::model::add("box");
  const int floor = add_floor(column, depth, size);
  int below = floor;
  std::map<std::string, std::vector<int>> regions;
  std::map<std::string, std::vector<int>> sides;
  for (const ColumnLayer& layer : column.layers) {
    gmsh::vectorpair made;
    geo::extrude({{2, below}}, 0.0, 0.0, column.level(layer.top) - column.level(layer.bottom),
                 made);
    // `made` has the opposite surface, the volume, and a side for each line of the floor.
    below = made[0].second;
    regions[layer.region].push_back(made[1].second);
    const std::array names{"front", "right", "back", "left"};
    for (std::size_t i = 0; i < names.size(); ++i) sides[names[i]].push_back(made[i + 2].second);
  }
  geo::synchronize();
  for (const auto& [region, volumes] : regions) name_group(3, volumes, region);
  for (const auto& [side, surfaces] : sides) name_group(2, surfaces, side);
  name_group(2, {floor}, column.lower_boundary);
  name_group(2, {below}, column.upper_boundary);
  gmsh::model::mesh::generate(3);
}

}  // namespace suffuse
