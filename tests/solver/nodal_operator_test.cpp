#include "explicit/nodal_operator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "common/errors.hpp"
#include "explicit/steady_nodal.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace nodal_operator_test {

/// Uneven porosities on a distorted mesh.
double uneven(const Vector<2>& x) {
  return 0.45 + 0.25 * std::sin(17.0 * x[0] + 29.0 * x[1]);
}

struct Square {
  explicit Square(std::vector<BoundaryCondition> boundaries)
      : c(make(std::move(boundaries))),
        grid(c.mesh),
        coefficients(model::flow_coefficients(grid, 0.02, uneven)),
        op(grid, face_conditions(c, grid), Vector<2>::Zero()) {
    op.update(coefficients);
  }
  static Case<2> make(std::vector<BoundaryCondition> boundaries) {
    Scene scene = model::paper_scene();
    scene.boundaries = std::move(boundaries);
    return model::make_case(model::column_mesh(5, 6, 1.0, 1.0, model::jittered(0.05, 2)), scene);
  }
  [[nodiscard]] double flux_through(const std::string& name, const VectorField<2>& v) const {
    double sum = 0.0;
    for (const auto& set : c.mesh.boundaries) {
      if (set.name != name) continue;
      for (const auto& nodes : set.faces) sum += op.face_flux(grid.find_face(nodes), v);
    }
    return sum;
  }

  Case<2> c;
  Grid<2> grid;
  FlowCoefficients<2> coefficients;
  NodalOperator<2> op;
};

TEST(NodalOperator, ForceIsTheTransposeOfTheFlux) {
  Square s({model::pressure_on("top", 0.0), model::pressure_on("bottom", 0.0)});
  std::mt19937_64 random(4);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
  std::vector<double> p(s.c.mesh.element_count());
  for (double& value : p) value = uniform();
  VectorField<2> v(s.c.mesh.node_count());
  for (auto& value : v) value = {uniform(), uniform()};
  s.op.constrain(v);
  // Power of the force on the flux at the nodes equals pressure times net outflow.
  double at_nodes = 0.0;
  for (int i = 0; i < s.c.mesh.node_count(); ++i) {
    at_nodes += s.op.node_porosity()[i] * v[i].dot(s.op.force(i, p));
  }
  double at_elements = 0.0;
  for (int f = 0; f < s.grid.face_count(); ++f) {
    const double flux = s.op.face_flux(f, v);
    at_elements += flux * p[s.grid.face_left[f]];
    if (!s.grid.is_outer(f)) at_elements -= flux * p[s.grid.face_right[f]];
  }
  EXPECT_NEAR(at_nodes, at_elements, 1e-14);
  EXPECT_GT(std::abs(at_nodes), 1e-3);
}

TEST(NodalOperator, NothingCrossesAWallWhateverTheVelocity) {
  Square s({model::pressure_on("top", 0.0)});
  const VectorField<2> v(s.c.mesh.node_count(), Vector<2>(0.3, -0.7));
  for (const char* wall : {"left", "right", "bottom"}) EXPECT_EQ(s.flux_through(wall, v), 0.0);
  EXPECT_NE(s.flux_through("top", v), 0.0);
}

TEST(NodalOperator, PrescribedFluxAndVelocityEnter) {
  BoundaryCondition velocity;
  velocity.on = "top";
  velocity.velocity = 0.12;
  Square by_velocity({velocity, model::pressure_on("bottom", 0.0)});
  Square by_flux({model::flux_on("top", 0.012), model::pressure_on("bottom", 0.0)});
  const VectorField<2> rest(by_flux.c.mesh.node_count(), Vector<2>::Zero());
  EXPECT_NEAR(by_flux.flux_through("top", rest), -0.012, 1e-15);
  // Intrinsic velocity: the flux follows with the porosity at the boundary's nodes.
  double porosity = 0.0;
  for (int i = 0; i <= 5; ++i) {
    const int node = 6 * 6 + i;
    porosity += by_velocity.op.node_porosity()[node] * (i == 0 || i == 5 ? 0.5 : 1.0);
  }
  const auto& mesh = by_velocity.c.mesh;
  double expected = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double length = (mesh.nodes[36 + i + 1] - mesh.nodes[36 + i]).norm();
    expected += 0.12 * length * 0.5 *
                (by_velocity.op.node_porosity()[36 + i] + by_velocity.op.node_porosity()[37 + i]);
  }
  EXPECT_NEAR(by_velocity.flux_through("top", rest), -expected, 1e-15);
  // The velocity of the nodes is the prescribed one.
  VectorField<2> v = rest;
  by_velocity.op.constrain(v);
  EXPECT_NEAR(v[38][1], -0.12, 1e-15);
  EXPECT_NEAR(v[36][0], 0.0, 1e-15) << "a corner is held by the wall as well";
  EXPECT_NEAR(v[36][1], -0.12, 1e-15);
}

TEST(NodalOperator, AWallAtAnyAngleLetsLiquidSlideAlongIt) {
  Square s({});
  // Rotates the square by 30 degrees: side walls are then neither vertical nor horizontal.
  Case<2> c = s.c;
  const Eigen::Rotation2Dd turn(0.5);
  for (auto& x : c.mesh.nodes) x = turn * x;
  const Grid<2> grid(c.mesh);
  NodalOperator<2> op(grid, face_conditions(c, grid), Vector<2>::Zero());
  op.update(s.coefficients);
  VectorField<2> v(c.mesh.node_count(), Vector<2>(1.0, 0.0));
  op.constrain(v);
  const int on_bottom = 2;
  const Vector<2> along = turn * Vector<2>(1.0, 0.0);
  EXPECT_NEAR((v[on_bottom] - along.dot(Vector<2>(1.0, 0.0)) * along).norm(), 0.0, 1e-14);
  EXPECT_EQ(v[0].norm(), 0.0) << "a corner between two walls does not move";
}

TEST(NodalOperator, ConditionsThatMeetOnAFaceAreRefused) {
  Case<2> c = Square::make({model::pressure_on("top", 1.0), model::pressure_on("lid", 2.0)});
  c.mesh.boundaries.push_back({"lid", c.mesh.boundaries[0].faces});
  const Grid<2> grid(c.mesh);
  EXPECT_THROW(face_conditions(c, grid), InputError);
}

TEST(SteadyFlow, IsDarcysLaw) {
  // Uniform soil in columns driven by a flux and by pressures: p is linear, q = k i.
  Scene scene = model::paper_scene();
  scene.boundaries = {model::pressure_on("top", 6000.0), model::pressure_on("bottom", 0.0)};
  const Case<2> c =
      model::make_case(model::column_mesh(5, 6, 1.0, 1.0, model::jittered(0.05, 2)), scene);
  const Grid<2> grid(c.mesh);
  const FlowCoefficients<2> coefficients = model::flow_coefficients(grid, 0.02);
  NodalOperator<2> op(grid, face_conditions(c, grid), Vector<2>::Zero());
  op.update(coefficients);
  const auto state = steady_flow(op);
  EXPECT_LE(state.imbalance, 1e-10);
  for (int e = 0; e < c.mesh.element_count(); ++e) {
    EXPECT_NEAR(state.pressure[e], 6000.0 * element_centroid(c.mesh, e)[1], 1e-5);
  }
  for (const auto& v : state.velocity) {
    EXPECT_NEAR(v[1], -0.02 * 6000.0 / 9810.0 / 0.3, 1e-12);
    EXPECT_NEAR(v[0], 0.0, 1e-12);
  }
}

}  // namespace nodal_operator_test
}  // namespace suffuse
