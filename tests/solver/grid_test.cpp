#include "grid/grid.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "grid/compensated_sum.hpp"
#include "grid/element_field.hpp"
#include "grid/face_flux.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace {

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
      // Out of the element: away from its centroid.
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
  // The linear field through its vertex values, at field node 0.
  EXPECT_NEAR(2.0 / 3.0 * vertices[0] + (vertices[1] + vertices[2]) / 6.0, values[0], 1e-14);
  EXPECT_NEAR(Nodes::value(values, {0.2, 0.3, 0.5}),
              0.2 * vertices[0] + 0.3 * vertices[1] + 0.5 * vertices[2], 1e-14);
}

/// Fluxes through faces of a field that is the same everywhere.
std::vector<double> uniform_flux(const Grid<2>& grid, const Vector<2>& q) {
  std::vector<double> flux;
  for (const Vector<2>& normal : grid.face_normal) flux.push_back(q.dot(normal));
  return flux;
}

TEST(FluxInTime, IsExactWhereTheFluxDoesNotTurn) {
  const Grid<2> grid(mesh);
  const Vector<2> direction(0.6, -0.8);
  for (const double share : {0.1, 0.5, 0.77, 1.0}) {
    // From 1 to 3 m/s.
    const FluxInTime flux{uniform_flux(grid, 2.0 * direction), uniform_flux(grid, 2.0 * direction),
                          share};
    const double mean = mean_magnitude_at(grid, flux, 3, element_centroid(mesh, 3));
    EXPECT_NEAR(mean, 1.0 + share, 1e-14);
  }
}

TEST(FluxInTime, WhatItComesToGrowsWhereTheFluxTurns) {
  const Grid<2> grid(mesh);
  // Through zero, turned about, and aside.
  for (const auto& [begin, end] : {std::pair{Vector<2>(1.0, 0.0), Vector<2>(-0.5, 0.0)},
                                   std::pair{Vector<2>(1.0, 0.0), Vector<2>(-2.0, 0.0)},
                                   std::pair{Vector<2>(1.0, 0.0), Vector<2>(0.0, 1.0)}}) {
    const Vector<2> mean = 0.5 * (begin + end);
    double last = 0.0;
    for (int k = 1; k <= 20; ++k) {
      const double share = k / 20.0;
      const FluxInTime flux{uniform_flux(grid, mean), uniform_flux(grid, end - begin), share};
      const double all = share * mean_magnitude_at(grid, flux, 7, element_centroid(mesh, 7));
      EXPECT_GE(all, last);
      last = all;
    }
    EXPECT_NEAR(last, mean.norm(), 1e-14);
  }
}

TEST(CompensatedSum, KeepsWhatAPlainSumLoses) {
  CompensatedSum sum;
  sum.add(1e16);
  for (int i = 0; i < 1000; ++i) sum.add(0.3);
  sum.add(-1e16);
  EXPECT_NEAR(sum.value(), 300.0, 1e-10);  // a plain sum gives 0
}

}  // namespace
}  // namespace suffuse
