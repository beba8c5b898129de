#include "grid/grid.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "grid/element_field.hpp"
#include "grid/extrapolated_flux.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace grid_test {

const Mesh<2> mesh = model::column_mesh(5, 4, 1.0, 1.0, model::jittered(0.06, 1));

TEST(Grid, CountsFacesByEuler) {
  const Grid<2> grid(mesh);
  EXPECT_EQ(mesh.node_count() - grid.face_count() + mesh.element_count(), 1);
  int outer = 0;
  for (int f = 0; f < grid.face_count(); ++f) outer += grid.is_outer(f) ? 1 : 0;
  EXPECT_EQ(outer, 2 * (5 + 4));
}

TEST(Grid, OutwardNormalsOfAnElementAddUpToZero) {
  const Grid<2> grid(mesh);
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vector<2> sum = Vector<2>::Zero();
    for (int k = 0; k < 3; ++k) {
      const int f = grid.element_face[e][k];
      const double sign = grid.element_face_sign[e][k];
      sum += sign * grid.face_normal[f];
      // The normal points out of the element, away from its centroid.
      EXPECT_GT(sign * grid.face_normal[f].dot(grid.face_centre(f) - element_centroid(mesh, e)),
                0.0);
      EXPECT_EQ(sign > 0.0 ? grid.face_left[f] : grid.face_right[f], e);
    }
    EXPECT_NEAR(sum.norm(), 0.0, 1e-15);
  }
}

TEST(Grid, GradientsReproduceALinearFunction) {
  const Grid<2> grid(mesh);
  const Vector<2> slope(1.7, -0.4);
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vector<2> gradient = Vector<2>::Zero();
    for (int k = 0; k < 3; ++k) {
      gradient += slope.dot(mesh.nodes[mesh.elements[e][k]]) * grid.shape_gradient[e][k];
    }
    EXPECT_NEAR((gradient - slope).norm(), 0.0, 1e-13);
  }
  EXPECT_NEAR(std::accumulate(grid.node_volume.begin(), grid.node_volume.end(), 0.0), 1.0, 1e-14);
}

TEST(FieldNodes, BasisIsOneAtItsNodeAndAddsUpToOne) {
  using Nodes = FieldNodes<2>;
  EXPECT_NEAR(Nodes::basis(Nodes::near_vertex), 1.0, 1e-15);
  EXPECT_NEAR(Nodes::basis(Nodes::far_vertex), 0.0, 1e-15);
  const ElementValues<2> values{2.0, -1.0, 5.0};
  const ElementValues<2> vertices = Nodes::at_vertices(values);
  // The value of the linear field with these vertex values at field node 0.
  EXPECT_NEAR(2.0 / 3.0 * vertices[0] + (vertices[1] + vertices[2]) / 6.0, values[0], 1e-14);
  EXPECT_NEAR(Nodes::value(values, {0.2, 0.3, 0.5}),
              0.2 * vertices[0] + 0.3 * vertices[1] + 0.5 * vertices[2], 1e-14);
}

TEST(FluxHistory, GoesOnAsItDid) {
  // Linear in time: the mean over 4 s is 2, the value at their end 3, so the mean over the next 2 s
  // is 3.5.
  const FluxHistory flux{{2.0, -1.0}, {3.0, -1.0}, 4.0};
  EXPECT_EQ(flux.extrapolated(4.0), (std::vector<double>{4.0, -1.0}));
  EXPECT_EQ(flux.extrapolated(2.0), (std::vector<double>{3.5, -1.0}));
  EXPECT_EQ(flux.extrapolated(0.0), flux.end);
  // Extrapolation is limited in time.
  EXPECT_EQ(flux.extrapolated(1e9), flux.extrapolated(16.0));
}

}  // namespace grid_test
}  // namespace suffuse
