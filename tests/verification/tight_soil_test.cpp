/// Clay on gravel in which water flows: the pressures of the clay do not depend on how much flows
/// in the gravel, ten billion times as much as in the clay or more.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model_run.hpp"

namespace suffuse {
namespace tight_soil_test {

/// Clay on gravel, a metre each, under heads at the sides of the gravel.
Case<2> clay_on_gravel(double clay, double gravel, bool retains) {
  Mesh<2> mesh = model::column_mesh(10, 10, 2.0, 2.0);
  mesh.region_names = {"gravel", "clay"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 1.0 ? 1 : 0;
  }
  for (BoundarySet<2>& side : mesh.boundaries) {
    if (side.name != "left" && side.name != "right") continue;
    std::erase_if(side.faces, [&](const auto& face) { return mesh.nodes[face[0]][1] >= 1.0; });
  }
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = 1.0;
  scene.initial_flow = InitialFlow::rest;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.inertia = false;
  scene.time.end = 1e8;
  scene.liquid.bulk_modulus = 2e9;
  scene.soils[0].region = "gravel";
  scene.soils[0].conductivity = gravel;
  scene.soils.push_back(scene.soils[0]);
  scene.soils[1].region = "clay";
  scene.soils[1].conductivity = clay;
  scene.boundaries.assign(3, {});
  scene.boundaries[0].on = "left";
  scene.boundaries[0].head = TimeFunction({{0.0, 1.0}, {1e6, retains ? 1.4 : 2.6}});
  scene.boundaries[1].on = "right";
  scene.boundaries[1].head = TimeFunction({{0.0, 1.0}, {1e6, retains ? 1.0 : 2.2}});
  scene.boundaries[2].on = "top";
  scene.boundaries[2].seepage_face = true;
  if (retains) {
    scene.soils[1].retention.law = retention_law("van-genuchten");
    scene.soils[1].retention.parameters.alpha = 0.5;
    scene.soils[1].retention.parameters.n = 1.4;
  }
  return model::make_case(std::move(mesh), scene);
}

/// Pressures of the elements at the end, Pa.
std::vector<double> pressures(double clay, double gravel, bool retains) {
  model::ModelRun run(clay_on_gravel(clay, gravel, retains));
  const FlowState<2> end = run.run({1e8}).flows.back();
  EXPECT_LT(run.worst_residual(), 1e-12);
  return end.pressure;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t e = 0; e < a.size(); ++e) largest = std::max(largest, std::abs(a[e] - b[e]));
  return largest;
}

// 30 Pa are 3 mm of head, a hundredth of what the heads change.
TEST(TightSoil, UnderSuctionIsSolvedBesideStrongFlow) {
  const std::vector<double> beside_weak = pressures(1e-9, 1e-5, true);
  EXPECT_LT(largest_difference(pressures(1e-9, 1e-2, true), beside_weak), 30.0);
  EXPECT_LT(largest_difference(pressures(1e-9, 1e-1, true), beside_weak), 30.0);
}

TEST(TightSoil, BelowASeepageFaceIsSolvedBesideStrongFlow) {
  const std::vector<double> beside_weak = pressures(1e-12, 1e-6, false);
  EXPECT_LT(largest_difference(pressures(1e-12, 1e-2, false), beside_weak), 30.0);
  EXPECT_LT(largest_difference(pressures(1e-12, 1e-1, false), beside_weak), 30.0);
}

}  // namespace tight_soil_test
}  // namespace suffuse
