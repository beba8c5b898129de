/// Pumped wells: in a disc, h2 - h1 = Q / (2 pi k) ln(r2 / r1); in layers, which share its rate.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include "model_run.hpp"
#include "scene/lognormal_field.hpp"

namespace suffuse {
namespace well_test {

constexpr double inner = 0.1;   // m
constexpr double outer = 10.0;  // m
constexpr double k = 1e-4;      // m/s
constexpr double rate = 2e-4;   // m2/s, out of the whole disc

/// A quarter of the disc: elements in rings whose radii grow by a constant factor.
double error_in_head(int rings) {
  Mesh<2> mesh = model::column_mesh(rings, rings, 1.0, 1.0, [](const Vector<2>& x) {
    const double r = inner * std::pow(outer / inner, x[0]);
    const double angle = 0.5 * std::numbers::pi * x[1];
    return Vector<2>(r * std::cos(angle), r * std::sin(angle));
  });
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.initial_flow = InitialFlow::steady;
  scene.soils[0].conductivity = k;
  BoundaryCondition well;
  well.on = "left";
  well.rate = TimeFunction(-0.25 * rate);
  BoundaryCondition rim;
  rim.on = "right";
  rim.head = TimeFunction(0.0);
  rim.concentration = 0.0;
  scene.boundaries = {well, rim};
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  const FlowState<2> flow = run.model().flow_state();
  const Grid<2>& grid = run.model().grid();
  // Between the well and a radius in the middle, as means over the faces there.
  const auto head_at = [&](double x) {
    double sum = 0.0;
    int count = 0;
    const double radius = inner * std::pow(outer / inner, x);
    for (int f = 0; f < grid.face_count(); ++f) {
      const auto& nodes = grid.face_nodes[f];
      const auto on_circle = [&](int node) {
        return std::abs(grid.mesh.nodes[node].norm() / radius - 1.0) < 1e-9;
      };
      if (!on_circle(nodes[0]) || !on_circle(nodes[1])) continue;
      sum += flow.face_pressure[f] / 9810.0;
      ++count;
    }
    return sum / count;
  };
  EXPECT_NEAR(run.state().history.flux_in, 0.25 * rate, 1e-12 * rate);
  const double exact = rate / (2.0 * std::numbers::pi * k) * 0.5 * std::log(outer / inner);
  return (head_at(0.5) - head_at(0.0)) / exact - 1.0;
}

TEST(Well, DrawsTheHeadDownByTheLogarithm) {
  const double coarse = error_in_head(20);
  const double fine = error_in_head(40);
  const double order = std::log2(coarse / fine);
  std::cout << "difference of heads off by " << coarse << ", " << fine << ", order " << order
            << '\n';
  EXPECT_LT(std::abs(fine), 5e-3);
  EXPECT_GT(order, 1.8);
}

/// A well through sand and clay with bedding, at the end of horizontal layers: in both the head
/// falls linearly to the well, which has one level.
TEST(Well, TakesFromLayersAsOneLevelWould) {
  constexpr double length = 10.0;                 // m
  constexpr double sand = 1e-4;                   // m/s
  constexpr double clay = 1e-7;                   // m/s, along its bedding
  constexpr double transmissivity = sand + clay;  // of two layers of 1 m, m2/s
  Mesh<2> mesh = model::column_mesh(10, 8, length, 2.0);
  mesh.region_names.emplace_back("clay");
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (element_centroid(mesh, e)[1] > 1.0) mesh.element_region[e] = 1;
  }
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = 10.0;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils[0].conductivity = sand;
  scene.soils.push_back(scene.soils[0]);
  // A random field whose waves are much longer than the layer multiplies its conductivity.
  scene.soils[0].field = {.variation = 0.5, .along = 1e12, .across = 1e12, .seed = 3};
  const double factor = LognormalField(scene.soils[0].field, 0.0).at(5.0, 0.0, 0.5);
  EXPECT_GT(std::abs(std::log(factor)), 0.1);
  scene.soils[0].conductivity = sand / factor;
  scene.soils[1].region = "clay";
  scene.soils[1].conductivity = clay;
  scene.soils[1].conductivity_across = 0.01 * clay;
  BoundaryCondition well;
  well.on = "left";
  well.rate = TimeFunction({{0.0, -1e-5}, {10.0, -3e-5}});
  BoundaryCondition rim;
  rim.on = "right";
  rim.head = TimeFunction(0.0);
  scene.boundaries = {well, rim};
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  const auto expect_level = [&](double pumped) {
    const FlowState<2> flow = run.model().flow_state();
    const Grid<2>& grid = run.model().grid();
    const double level = -pumped * length / transmissivity;
    for (int f = 0; f < grid.face_count(); ++f) {
      if (!grid.is_outer(f) || grid.face_centre(f)[0] > 1e-9) continue;
      EXPECT_NEAR(flow.face_pressure[f] / 9810.0, level, 1e-9 * pumped * length / transmissivity)
          << "at a height of " << grid.face_centre(f)[1] << " m";
    }
  };
  expect_level(1e-5);
  static_cast<void>(run.run({10.0}));
  expect_level(3e-5);
}

}  // namespace well_test
}  // namespace suffuse
