/// Heavy liquid drives light liquid: two columns of different concentrations, joined above and
/// below by gravel, carry q = k (rho_1 - rho_2) / rho_w H / (L_1 + L_2). And where a slow flow
/// erodes in proportion to itself, the weight of the fines doubles the erosion.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "driver/row_checks.hpp"
#include "grid/face_flux.hpp"
#include "mixed/implicit_mixed.hpp"
#include "physics/liquid.hpp"
#include "solver/flow_model.hpp"
#include "verification/model_run.hpp"

namespace suffuse {
namespace density_loop_test {

constexpr int columns = 5;
constexpr int rows = 12;

/// A ring of cells: the columns at both sides, the rows at top and bottom.
Mesh<2> ring() {
  Mesh<2> whole = model::column_mesh(columns, rows, 0.5, 1.2);
  Mesh<2> mesh = whole;
  mesh.elements.clear();
  for (int e = 0; e < whole.element_count(); ++e) {
    const Vector<2> x = element_centroid(whole, e);
    const bool inside = x[0] > 0.1 && x[0] < 0.4 && x[1] > 0.1 && x[1] < 1.1;
    if (!inside) mesh.elements.push_back(whole.elements[e]);
  }
  mesh.element_region.assign(mesh.elements.size(), 0);
  return mesh;
}

TEST(DensityLoop, OfTwoColumns) {
  model::FlowModel m(ring());
  const auto is_column = [](const Vector<2>& x) { return x[1] > 0.1 && x[1] < 1.1; };
  m.set_conductivity([&](const Vector<2>& x) { return is_column(x) ? 1e-4 : 1.0; });
  const double heavy = mixture_density(0.03, 1000.0, 2650.0);
  const double light = mixture_density(0.01, 1000.0, 2650.0);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(m.mesh, e);
    m.forcing.coefficients.mixture_density[e] = !is_column(x) ? 1000.0
                                                : x[0] < 0.25 ? heavy
                                                              : light;
  }
  ImplicitMixed<2> flow(m.grid, {}, Vector<2>(0.0, -9.81));
  const MixedStep<2> steady = flow.steady(m.forcing);
  const std::vector<Vector<2>> flux = element_flux(m.grid, steady.face_flux);
  const double exact = 1e-4 * (heavy - light) / 1000.0 * 1.0 / 2.0;
  double down = 0.0;
  double up = 0.0;
  double volume = 0.0;
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(m.mesh, e);
    if (!is_column(x)) continue;
    (x[0] < 0.25 ? down : up) += m.grid.volume[e] * flux[e][1];
    volume += 0.5 * m.grid.volume[e];
  }
  EXPECT_NEAR(-down / volume, exact, 1e-3 * exact);
  EXPECT_NEAR(up / volume, exact, 1e-3 * exact);
}

/// Soil 1 m long and 0.5 m high, with water 1 cm higher on the left than on the right: lambda = 3
/// 1/m, k = 1 mm/s. Drag is Darcy's at a constant conductivity.
class SlowSeepage : public testing::Test {
 protected:
  static Case<2> slow_seepage(double gravity) {
    Scene scene = model::paper_scene();
    scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
    scene.gravity = {0.0, -gravity, 0.0};
    scene.time.scheme = FlowScheme::implicit_mixed;
    scene.initial_flow = InitialFlow::steady;
    scene.time.end = 5666.0;
    scene.soils[0].conductivity = 1e-3;
    scene.soils[0].erosion.law = erosion_law("flux");
    scene.soils[0].erosion.rate = 3.0;
    const bool heads = gravity > 0.0;
    scene.boundaries = {model::pressure_on("left", 98.1), model::pressure_on("right", 0.0)};
    for (BoundaryCondition& boundary : scene.boundaries) {
      boundary.concentration = 0.0;
      if (!heads) continue;
      boundary.pressure.reset();
      boundary.head = boundary.on == "left" ? 0.51 : 0.5;
    }
    return model::make_case(model::column_mesh(28, 14, 1.0, 0.5), scene);
  }
};

TEST_F(SlowSeepage, WithoutWeightLosesWhatTheHeadsTake) {
  model::ModelRun run(slow_seepage(0.0));
  const LedgerRow end = run.run({5666.0}).states.back().ledger;
  EXPECT_NEAR(end.eroded / (end.eroded + end.erodible), -std::expm1(-3.0 * 1e-5 * 5666.0), 1e-4);
  EXPECT_EQ(run.state().history.fines_weight_share, 0.0);
}

TEST_F(SlowSeepage, WithWeightLosesTwiceAsMuchAndSaysSo) {
  // A separate program with first-order finite volumes on 60 x 30 and 120 x 60 cells gives 0.12581
  // and 0.12671 by 2833 s, 0.31656 and 0.31519 by 5666 s.
  model::ModelRun run(slow_seepage(9.81));
  const auto states = run.run({2833.0, 5666.0}).states;
  EXPECT_NEAR(states[0].ledger.eroded / 135.0, 0.127, 0.002);
  EXPECT_NEAR(states[1].ledger.eroded / 135.0, 0.315, 0.004);
  EXPECT_GT(states[1].history.fines_weight_share, 0.5);
  RowChecks checks(run.input().document.scene);
  ASSERT_EQ(checks.check(states[1].history).size(), 1U);
}

}  // namespace density_loop_test
}  // namespace suffuse
