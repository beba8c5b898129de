/// Depth of points below the surface of the soil.

#include "boundary/soil_depth.hpp"

#include <gtest/gtest.h>

#include "../box_mesh.hpp"

namespace suffuse {
namespace soil_depth_test {

constexpr int cells = 4;

/// A point in the middle of each element with its centre below `level`.
template <int Dim>
SolidPoints<Dim> points_below(const Mesh<Dim>& mesh, double level) {
  std::vector<PointPlace<Dim>> places;
  std::array<double, Dim + 1> middle;
  middle.fill(1.0 / (Dim + 1));
  for (int e = 0; e < mesh.element_count(); ++e) {
    double height = 0.0;
    for (const int node : mesh.elements[e]) height += mesh.nodes[node][Dim - 1] / (Dim + 1);
    if (height < level) places.push_back({e, middle});
  }
  return {mesh, places, std::vector<double>(places.size(), 1.0)};
}

/// The cube, of which all but the top is held; soil up to `level`, at which it ends.
TEST(SoilDepth, IsTheDistanceToTheTopOfTheSoil) {
  const Mesh<3> mesh = model::box_mesh({cells, cells, cells});
  const Grid<3> grid(mesh);
  std::vector<Support> held(grid.face_count(), Support::none);
  for (int f = 0; f < grid.face_count(); ++f) {
    if (grid.is_border(f) && grid.face_centre(f)[2] < 1.0) held[f] = Support::normal;
  }
  const Supports<3> supports(grid, held);
  for (const double level : {0.5, 0.75, 1.0}) {
    const SolidPoints<3> points = points_below(mesh, level);
    const PointsByElement sorted(mesh.element_count(), points.element);
    const std::vector<double> depths = depths_below_surface(grid, supports, points, sorted);
    ASSERT_EQ(depths.size(), 6U * cells * cells * static_cast<unsigned>(cells * level));
    for (std::size_t p = 0; p < depths.size(); ++p) {
      EXPECT_NEAR(depths[p], level - points.position[p][2], 1e-12);
    }
  }
}

/// Without supports all sides are surfaces, and the nearest one counts.
TEST(SoilDepth, IsTheDistanceToTheNearestSide) {
  const Mesh<3> mesh = model::box_mesh({cells, cells, cells});
  const Grid<3> grid(mesh);
  const Supports<3> supports(grid, std::vector<Support>(grid.face_count(), Support::none));
  const SolidPoints<3> points = points_below(mesh, 1.0);
  const PointsByElement sorted(mesh.element_count(), points.element);
  const std::vector<double> depths = depths_below_surface(grid, supports, points, sorted);
  for (std::size_t p = 0; p < depths.size(); ++p) {
    const Vector<3>& x = points.position[p];
    EXPECT_NEAR(depths[p], std::min(x.minCoeff(), 1.0 - x.maxCoeff()), 1e-12);
  }
}

}  // namespace soil_depth_test
}  // namespace suffuse
