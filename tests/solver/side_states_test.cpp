/// Saturation and conductivity at the sides of elements, found once per face.

#include "mixed/side_states.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model_case.hpp"

namespace suffuse {
namespace side_states_test {

/// Elements of two soils, one of them filled with soil in part in some elements.
TEST(SideStates, AreThoseOfEachElementsOwnSoil) {
  const Mesh<2> mesh = model::column_mesh(4, 4);
  const Grid<2> grid(mesh);
  MixedModel<2> model{
      .grid = grid, .settings = {}, .gravity = {0.0, -9.81}, .soils = {}, .walls = {}};
  model.soils.head_per_pressure = 1.0 / 9810.0;
  const RetentionLaw* law = retention_law("van-genuchten");
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double alpha = e % 3 == 0 ? 4.0 : 2.0;
    model.soils.retention.push_back({law, 0.1, {.alpha = alpha, .n = 2.5}});
    model.soils.soil_share.push_back(e % 4 == 0 ? 0.5 : 1.0);
  }
  model.soils.free_space = {law, 0.0, {.alpha = 20.0, .n = 3.0}};
  std::vector<double> pressure(grid.face_count());
  for (int f = 0; f < grid.face_count(); ++f) pressure[f] = -500.0 * (f % 7) + 500.0;
  const SideStates<2> sides(model, pressure);
  int of_two = 0;  // faces between soils that differ
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int k = 0; k < 3; ++k) {
      const int f = grid.element_face[e][k];
      const RetentionState expected = model.soils.at(e, pressure[f]);
      const RetentionState found = sides.at(e, k);
      const auto expect_same = [](double a, double b) { EXPECT_NEAR(a, b, 1e-12 * std::abs(b)); };
      expect_same(found.saturation, expected.saturation);
      expect_same(found.capacity, expected.capacity);
      expect_same(found.relative_conductivity, expected.relative_conductivity);
      expect_same(found.conductivity_slope, expected.conductivity_slope);
      if (!model.soils.are_alike(e, grid.face_left[f])) ++of_two;
    }
  }
  EXPECT_GT(of_two, 5);
}

}  // namespace side_states_test
}  // namespace suffuse
