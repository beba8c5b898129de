/// A retention law changes nothing if no pressure is negative.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "model_run.hpp"

namespace suffuse {
namespace saturated_limit_test {

/// Soil under a head of 3 to 4 m, with erosion by the flux, bedding and fines in the inflow.
Scene confined_scene(bool retains) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::monotone;
  scene.time.step = 10.0;
  scene.time.end = 2000.0;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = 3.0;
  Soil& soil = scene.soils[0];
  soil.conductivity = 1e-4;
  soil.conductivity_across = 3e-5;
  soil.bedding = 20.0;
  soil.conductivity_law = conductivity_law("kozeny-carman");
  soil.erosion.law = erosion_law("flux");
  soil.erosion.rate = 5.0;
  if (retains) soil.retention = model::van_genuchten(2.0, 1.6);
  BoundaryCondition left;
  left.on = "left";
  left.head = TimeFunction({{0.0, 3.0}, {500.0, 4.0}});
  left.concentration = 0.02;
  BoundaryCondition right;
  right.on = "right";
  right.head = TimeFunction(3.0);
  right.concentration = 0.0;
  scene.boundaries = {left, right};
  return scene;
}

TEST(SaturatedLimit, ARetentionLawUnderWaterChangesNothing) {
  model::ModelRun plain(model::make_case(model::column_mesh(12, 8), confined_scene(false)));
  model::ModelRun under_law(model::make_case(model::column_mesh(12, 8), confined_scene(true)));
  const auto one = plain.run({2000.0});
  const auto two = under_law.run({2000.0});
  EXPECT_EQ(plain.steps(), under_law.steps());
  const auto largest = [](const std::vector<double>& a, const std::vector<double>& b) {
    double difference = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      difference = std::max(difference, std::abs(a[i] - b[i]));
      size = std::max(size, std::abs(a[i]));
    }
    return difference / size;
  };
  const double pressure = largest(one.flows[0].face_pressure, two.flows[0].face_pressure);
  const double flux = largest(one.flows[0].face_flux, two.flows[0].face_flux);
  const double porosity = largest(one.states[0].porosity, two.states[0].porosity);
  const double eroded = two.states[0].ledger.eroded / one.states[0].ledger.eroded - 1.0;
  std::cout << "pressure " << pressure << ", flux " << flux << ", porosity " << porosity
            << ", eroded " << eroded << " of " << one.states[0].ledger.eroded << " kg\n";
  EXPECT_GT(one.states[0].ledger.eroded, 1.0);
  EXPECT_LT(pressure, 1e-10);
  EXPECT_LT(flux, 1e-10);
  EXPECT_LT(porosity, 1e-10);
  EXPECT_LT(std::abs(eroded), 1e-10);
}

}  // namespace saturated_limit_test
}  // namespace suffuse
