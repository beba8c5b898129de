/// Elements that share their dilatation.

#include "equilibrium/shared_dilatation.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "box_mesh.hpp"
#include "grid/dilatation_patches.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace shared_dilatation_test {

template <int Dim>
Mesh<Dim> irregular_mesh();
template <>
Mesh<2> irregular_mesh() {
  return model::column_mesh(4, 3, 1.0, 1.0, model::jittered(0.05, 3));
}
template <>
Mesh<3> irregular_mesh() {
  return model::box_mesh({4, 2, 2}, Vector<3>::Ones(), model::disturbed(0.05));
}

std::vector<double> some_values(std::size_t count, double first) {
  std::vector<double> result(count);
  for (std::size_t e = 0; e < count; ++e)
    result[e] = std::sin(first + 3.0 * static_cast<double>(e));
  return result;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

template <int Dim>
void check_means() {
  const Mesh<Dim> mesh = irregular_mesh<Dim>();
  const Grid<Dim> grid(mesh);
  const SharedDilatation<Dim> dilatation(grid, grid.volume);
  const std::size_t count = mesh.elements.size();
  for (std::size_t e = 0; e < count; ++e) {
    EXPECT_TRUE(dilatation.is_shared(static_cast<int>(e)));
  }
  std::vector<double> ones(count, 1.0);
  dilatation.average(ones);
  for (const double one : ones) EXPECT_NEAR(one, 1.0, 1e-14);
  // All elements together keep their volume.
  const std::vector<double> values = some_values(count, 1.0);
  std::vector<double> means = values;
  dilatation.average(means);
  EXPECT_NEAR(product(grid.volume, means), product(grid.volume, values), 1e-14);
  EXPECT_NE(means, values);
  // The work of stresses on the means is that of the spread stresses.
  const std::vector<double> others = some_values(count, 2.0);
  EXPECT_NEAR(product(means, others), product(values, dilatation.spread(others)), 1e-13);
}

TEST(SharedDilatation, KeepsUniformRatiosAndTheVolumeOfAllElements) {
  check_means<2>();
  check_means<3>();
}

TEST(SharedDilatation, IsNotSharedOnCrossedTriangles) {
  const Mesh<2> mesh = model::crossed_mesh(3, 2, 1.0, 1.0);
  const Grid<2> grid(mesh);
  EXPECT_FALSE(SharedDilatation<2>(grid, grid.volume).acts());
}

TEST(SharedDilatation, IsNotSharedBetweenRegionsOrWithoutWeight) {
  Mesh<2> mesh = irregular_mesh<2>();
  mesh.region_names = {"below", "above"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 1.0 / 3.0 ? 1 : 0;
  }
  const Grid<2> grid(mesh);
  std::vector<double> weight = grid.volume;
  weight.back() = 0.0;
  const SharedDilatation<2> dilatation(grid, weight);
  std::vector<double> values(weight.size(), 2.0);
  for (std::size_t e = 0; e < values.size(); ++e) {
    if (mesh.element_region[e] == 1) values[e] = 3.0;
  }
  values.back() = 7.0;
  std::vector<double> means = values;
  dilatation.average(means);
  for (std::size_t e = 0; e < values.size(); ++e) EXPECT_NEAR(means[e], values[e], 1e-14);
  EXPECT_FALSE(dilatation.is_shared(static_cast<int>(values.size()) - 1));
}

/// Two triangles in a patch, but for the one that is left over; four tetrahedra in most.
TEST(DilatationPatches, AreOfTwoTrianglesAndFourTetrahedra) {
  const Mesh<2> flat = model::column_mesh(3, 3);
  const std::vector<int> pairs = dilatation_patches(Grid<2>(flat));
  for (int patch = 0; patch < 9; ++patch) EXPECT_EQ(std::ranges::count(pairs, patch), 2);
  const Mesh<3> solid = model::box_mesh({4, 4, 4});
  const std::vector<int> fours = dilatation_patches(Grid<3>(solid));
  const int count = 1 + std::ranges::max(fours);
  int of_four = 0;
  for (int patch = 0; patch < count; ++patch) {
    const auto size = std::ranges::count(fours, patch);
    EXPECT_GE(size, 3);
    EXPECT_LE(size, 6);
    if (size == 4) ++of_four;
  }
  EXPECT_EQ(std::ranges::count(fours, -1), 0);
  EXPECT_GE(of_four, count / 2);
}

}  // namespace shared_dilatation_test
}  // namespace suffuse
