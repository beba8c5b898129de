#include "values/point_cells.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "post/synthetic_results.hpp"

namespace suffuse {
namespace point_cells_test {

double area(const std::vector<Vector<2>>& corners) {
  double twice = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector<2>& a = corners[k];
    const Vector<2>& b = corners[(k + 1) % corners.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * twice;
}

/// The point whose cell is seen at a place, or none.
std::optional<std::size_t> seen_at(const std::vector<PointCell>& cells, const Vector<2>& x) {
  std::optional<std::size_t> seen;
  for (const PointCell& cell : cells) {
    bool inside = true;
    for (std::size_t k = 0; k < cell.corners.size(); ++k) {
      const Vector<2> a = cell.corners[k];
      const Vector<2> b = cell.corners[(k + 1) % cell.corners.size()];
      inside = inside && area({a, b, x}) > -1e-12;
    }
    if (inside) seen = cell.point;
  }
  return seen;
}

TEST(PointCells, PointsAtRestFillTheirElements) {
  const Case<2> c = testing::unit_square_case();
  std::vector<Vector<2>> positions;
  for (std::size_t p = 0; p < c.solid_points.element.size(); ++p) {
    positions.push_back(c.solid_points.position(c.mesh, static_cast<int>(p)));
  }
  const auto cells = point_cells(c.mesh, positions, {});
  ASSERT_EQ(cells.size(), positions.size());
  for (std::size_t p = 0; p < positions.size(); ++p) EXPECT_EQ(seen_at(cells, positions[p]), p);
  for (const double x : {0.02, 0.26, 0.51, 0.77}) {
    for (const double y : {0.03, 0.31, 0.62, 0.96}) EXPECT_TRUE(seen_at(cells, {x, y}));
  }
  EXPECT_TRUE(point_cells(c.mesh, {}, {}).empty());
}

/// A strip of unit squares of two triangles each.
Mesh<2> strip(int columns, int rows) {
  Mesh<2> mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) mesh.nodes.emplace_back(i, j);
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i;
      const int b = a + columns + 1;
      mesh.elements.push_back({a, a + 1, b + 1});
      mesh.elements.push_back({a, b + 1, b});
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  mesh.region_names = {"soil"};
  return mesh;
}

// The lower three of six rows are full of soil, but for one element without a point; one point
// flies above.
TEST(PointCells, SoilThatMovesHasNoHolesAndASurface) {
  const Mesh<2> mesh = strip(6, 6);
  std::vector<Vector<2>> positions;
  const int hole = 2 * (1 * 6 + 3);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(mesh, e);
    if (x[1] < 3.0 && e != hole) positions.push_back(x);
  }
  std::vector<double> volumes(positions.size(), 0.5);
  positions.emplace_back(2.5, 5.4);
  volumes.push_back(0.03);
  const auto cells = point_cells(mesh, positions, volumes);
  EXPECT_TRUE(seen_at(cells, element_centroid(mesh, hole))) << "a hole is closed";
  EXPECT_TRUE(seen_at(cells, {2.4, 2.9}));
  EXPECT_FALSE(seen_at(cells, {2.4, 3.2})) << "above the soil";
  EXPECT_EQ(seen_at(cells, positions.back()), positions.size() - 1) << "a point that flies";
  double flying = 0.0;
  for (const PointCell& cell : cells) {
    if (cell.point == positions.size() - 1) flying += area(cell.corners);
  }
  EXPECT_NEAR(flying, 0.03, 1e-3);
}

}  // namespace point_cells_test
}  // namespace suffuse
