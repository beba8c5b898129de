#include "mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/faces.hpp"

namespace suffuse {
namespace mesh_test {

Mesh<2> triangle(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c) {
  Mesh<2> mesh;
  mesh.nodes = {a, b, c};
  mesh.elements = {{0, 1, 2}};
  mesh.element_region = {0};
  mesh.region_names = {"specimen"};
  return mesh;
}

TEST(Mesh, AreaIsHalfBaseTimesHeightAndChangesSignWithTheOrder) {
  Mesh<2> mesh = triangle({1, 1}, {5, 1}, {2, 4});
  EXPECT_DOUBLE_EQ(element_volume(mesh, 0), 6.0);
  mesh.elements = {{0, 2, 1}};
  EXPECT_DOUBLE_EQ(element_volume(mesh, 0), -6.0);
}

TEST(Mesh, VolumeOfACornerOfTheUnitCubeIsASixth) {
  Mesh<3> mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.elements = {{0, 1, 2, 3}};
  EXPECT_DOUBLE_EQ(element_volume(mesh, 0), 1.0 / 6.0);
}

TEST(Mesh, CentroidIsTheMeanOfTheCorners) {
  const Vector<2> centroid = element_centroid(triangle({0, 0}, {3, 0}, {0, 6}), 0);
  EXPECT_DOUBLE_EQ(centroid[0], 1.0);
  EXPECT_DOUBLE_EQ(centroid[1], 2.0);
}

TEST(Mesh, BarycentricCoordinatesAreSharesOfTheArea) {
  const Mesh<2> mesh = triangle({1, 1}, {5, 1}, {2, 4});
  for (int k = 0; k < 3; ++k) {
    const auto at = barycentric(mesh, 0, mesh.nodes[k]);
    for (int j = 0; j < 3; ++j) EXPECT_DOUBLE_EQ(at[j], j == k ? 1.0 : 0.0);
  }
  // The point replaces one vertex after the other.
  for (const Vector<2>& x : {Vector<2>(2.0, 2.0), Vector<2>(4.0, 0.5), Vector<2>(-1.0, 3.0)}) {
    const auto at = barycentric(mesh, 0, x);
    for (int k = 0; k < 3; ++k) {
      Mesh<2> part = mesh;
      part.nodes[k] = x;
      EXPECT_NEAR(at[k], element_volume(part, 0) / 6.0, 1e-15);
    }
  }
  Mesh<3> corner;
  corner.nodes = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {0, 0, 5}};
  corner.elements = {{0, 1, 2, 3}};
  const auto at = barycentric(corner, 0, Vector<3>(0.5, 1.0, -1.0));
  EXPECT_NEAR(at[0], 1.0 - 0.25 - 0.25 + 0.2, 1e-15);
  EXPECT_NEAR(at[1], 0.25, 1e-15);
  EXPECT_NEAR(at[2], 0.25, 1e-15);
  EXPECT_NEAR(at[3], -0.2, 1e-15);
}

TEST(Mesh, SmallestAngleOfKnownTriangles) {
  const double of_345 = std::atan(3.0 / 4.0) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(smallest_angle(triangle({0, 0}, {4, 0}, {0, 3})), of_345, 1e-12);
  EXPECT_NEAR(smallest_angle(triangle({0, 0}, {1, 0}, {0.5, std::sqrt(0.75)})), 60.0, 1e-12);
  EXPECT_NEAR(smallest_angle(triangle({0, 0}, {1, 0}, {0.5, 1e-6})), 2e-6 * 180 / std::numbers::pi,
              1e-12);
}

TEST(Faces, OfTwoTrianglesOneIsSharedAndFourAreOuter) {
  Mesh<2> mesh = triangle({0, 0}, {1, 0}, {1, 1});
  mesh.nodes.emplace_back(0, 1);
  mesh.elements.push_back({0, 2, 3});
  const FaceTable<2> faces(mesh);
  EXPECT_EQ(faces.owners({2, 0}), 2);
  EXPECT_EQ(faces.owners({0, 1}), 1);
  EXPECT_EQ(faces.owners({3, 2}), 1);
  EXPECT_EQ(faces.owners({1, 3}), 0);
}

TEST(Faces, OppositeFaceLacksTheCorner) {
  const auto face = face_key<3>(face_opposite<3>({7, 5, 3, 1}, 2));
  EXPECT_EQ(face, (std::array<int, 3>{1, 5, 7}));
}

}  // namespace mesh_test
}  // namespace suffuse
