#include "explicit/locking.hpp"

#include <gtest/gtest.h>

#include "explicit/steady_nodal.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace locking_test {

/// Each square cut along both diagonals.
Mesh<2> crossed_mesh(int cells, double jitter) {
  Mesh<2> mesh = model::column_mesh(cells, cells, 1.0, 1.0, model::jittered(jitter / cells, 3));
  mesh.elements.clear();
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i;
      const std::array<int, 4> corner{a, a + 1, a + cells + 2, a + cells + 1};
      const Vector<2> first = mesh.nodes[corner[2]] - mesh.nodes[corner[0]];
      const Vector<2> second = mesh.nodes[corner[3]] - mesh.nodes[corner[1]];
      const Vector<2> between = mesh.nodes[corner[1]] - mesh.nodes[corner[0]];
      const double share = (between[0] * second[1] - between[1] * second[0]) /
                           (first[0] * second[1] - first[1] * second[0]);
      const int middle = mesh.node_count();
      mesh.nodes.emplace_back(mesh.nodes[corner[0]] + share * first);
      for (int k = 0; k < 4; ++k) {
        mesh.elements.push_back({corner[k], corner[(k + 1) % 4], middle});
      }
    }
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  return mesh;
}

struct TurningFlow {
  /// Liquid enters through the left quarter of the top and leaves through the right quarter.
  explicit TurningFlow(Mesh<2> mesh) : c(make(std::move(mesh))), grid(c.mesh) {
    coefficients = model::flow_coefficients(grid, 0.02);
    NodalOperator<2> op(grid, face_conditions(c, grid), Vector<2>::Zero());
    op.update(coefficients);
    const auto steady = steady_flow(op);
    deviation = *deviation_from_mixed_flow<2>(op, coefficients, steady.velocity);
    for (int f = 0; f < grid.face_count(); ++f) {
      if (grid.is_outer(f)) discharge += std::max(0.0, op.face_flux(f, steady.velocity));
    }
  }
  static Case<2> make(Mesh<2> mesh) {
    BoundarySet<2> in{"in", {}};
    BoundarySet<2> out{"out", {}};
    for (const auto& face : mesh.boundaries[0].faces) {
      const double x = 0.5 * (mesh.nodes[face[0]][0] + mesh.nodes[face[1]][0]);
      if (x < 0.25) in.faces.push_back(face);
      if (x > 0.75) out.faces.push_back(face);
    }
    mesh.boundaries = {in, out};
    Scene scene = model::paper_scene();
    scene.boundaries = {model::pressure_on("in", 6000.0), model::pressure_on("out", 0.0)};
    return model::make_case(std::move(mesh), scene);
  }

  Case<2> c;
  Grid<2> grid;
  FlowCoefficients<2> coefficients;
  double deviation = 0.0;
  double discharge = 0.0;
};

/// m2/s. Five-point finite differences on 64, 128, 256 and 512 cells across give 5.9994e-3,
/// 6.0472e-3, 6.0712e-3 and 6.0833e-3. Their differences halve; this is the limit.
constexpr double discharge_reference = 6.0953e-3;

TEST(Locking, IsSeenOnRegularAndFreeMeshes) {
  EXPECT_GT(TurningFlow(model::column_mesh(16, 16)).deviation, 0.99);
  EXPECT_GT(TurningFlow(model::column_mesh(16, 16, 1.0, 1.0, model::jittered(0.015, 3))).deviation,
            locked_deviation);
}

TEST(Locking, IsAbsentOnCrossedMeshes) {
  std::vector<double> deviations;
  for (const int cells : {4, 8, 16, 32}) {
    const TurningFlow flow(crossed_mesh(cells, 0.2));
    // The opening is a quarter of the width, which is only one element with four cells.
    if (cells >= 16) {
      EXPECT_LT(flow.deviation, locked_deviation);
    }
    deviations.push_back(flow.deviation);
    if (cells == 32) {
      EXPECT_NEAR(flow.discharge, discharge_reference, 0.1 * discharge_reference);
    }
  }
  EXPECT_LT(deviations[0], 0.5);
  // The pressure jumps along the top: the order is one half, as the solution is not smooth.
  EXPECT_GT(std::log2(deviations[2] / deviations[3]), 0.4);
}

TEST(Locking, IsNoMatterForTheColumn) {
  Scene scene = model::paper_scene();
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  const Case<2> c = model::make_case(model::column_mesh(4, 4), scene);
  const Grid<2> grid(c.mesh);
  const FlowCoefficients<2> coefficients = model::flow_coefficients(grid, 0.02);
  NodalOperator<2> op(grid, face_conditions(c, grid), Vector<2>::Zero());
  op.update(coefficients);
  EXPECT_NEAR(*deviation_from_mixed_flow<2>(op, coefficients, steady_flow(op).velocity), 0.0,
              1e-10);
}

}  // namespace locking_test
}  // namespace suffuse
