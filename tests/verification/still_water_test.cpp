/// Water at rest under gravity stays at rest and erodes nothing.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "grid/face_flux.hpp"
#include "model_run.hpp"

namespace suffuse {
namespace still_water_test {

constexpr double ten_days = 864000.0;  // s
constexpr double level = 3.0;          // m, of the pond
constexpr double stiff = std::numeric_limits<double>::infinity();

BoundaryCondition head_on(const std::string& name, double head) {
  BoundaryCondition b;
  b.on = name;
  b.head = head;
  b.concentration = 0.0;
  return b;
}

/// Soil 2 m high under 1 m of water. Fines erode by the flux.
Scene pond_scene(double bulk_modulus) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = ten_days;
  scene.liquid.bulk_modulus = bulk_modulus;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = level;
  scene.soils[0].conductivity = 1e-3;
  scene.soils[0].erosion.law = erosion_law("flux");
  scene.soils[0].erosion.rate = 100.0;
  scene.boundaries = {head_on("top", level)};
  return scene;
}

Mesh<2> pond_mesh(double amount = 0.0) {
  return model::column_mesh(4, 12, 1.0, 2.0, [&](const Vector<2>& x) -> Vector<2> {
    const bool inside = x[0] > 0.0 && x[0] < 1.0 && x[1] > 0.0 && x[1] < 2.0;
    if (!inside) return x;
    return x + amount * Vector<2>(std::sin(97.0 * x[0] + 31.0 * x[1]), std::cos(53.0 * x[1]));
  });
}

/// Checks the largest flux through a face, m/s, over ten days, and the eroded mass, kg.
void expect_still(const std::string& what, Mesh<2> mesh, const Scene& scene) {
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  double largest = 0.0;
  const Grid<2>& grid = run.model().grid();
  for (int day = 1; day <= 10; ++day) {
    const auto moments = run.run({day * ten_days / 10});
    for (int f = 0; f < grid.face_count(); ++f) {
      const double flux = std::abs(moments.flows.back().face_flux[f]);
      largest = std::max(largest, flux / grid.face_normal[f].norm());
    }
  }
  const LedgerRow ledger = run.model().ledger();
  std::cout << what << ": |q| up to " << largest << " m/s, " << ledger.eroded << " kg eroded of "
            << ledger.erodible << ", " << run.steps() << " steps\n";
  EXPECT_LT(largest, 1e-10) << what;
  EXPECT_EQ(ledger.eroded, 0.0) << what;
  EXPECT_LT(run.worst_residual(), 1e-12) << what;
}

TEST(StillWater, UnderAPondErodesNothingInTenDays) {
  for (const double modulus : {2e7, 2e9, stiff}) {
    for (const auto stepping : {TimeStepping::second_order, TimeStepping::monotone}) {
      Scene scene = pond_scene(modulus);
      scene.time.stepping = stepping;
      const std::string what =
          "K " + std::to_string(modulus) + (stepping == TimeStepping::monotone ? ", monotone" : "");
      expect_still(what, pond_mesh(), scene);
      expect_still(what + ", irregular mesh", pond_mesh(0.03), scene);
    }
  }
}

/// Three layers with conductivities 1e5 apart; the two upper ones retain water above its level.
Scene layered_scene(double bulk_modulus) {
  Scene scene = pond_scene(bulk_modulus);
  scene.time.stepping = TimeStepping::monotone;
  scene.water_level = 0.7;
  scene.boundaries = {head_on("left", 0.7)};
  Soil& low = scene.soils[0];
  low.retention = model::van_genuchten(2.0, 1.6);
  Soil middle = low;
  middle.region = "middle";
  middle.porosity = 0.36;
  middle.conductivity = 1e-8;
  middle.retention = model::van_genuchten(0.5, 1.2);
  Soil high = low;
  high.region = "high";
  high.conductivity = 1e-2;
  high.retention = model::van_genuchten(14.5, 2.68);
  scene.soils = {low, middle, high};
  return scene;
}

Mesh<2> layered_mesh() {
  Mesh<2> mesh = pond_mesh();
  mesh.region_names = {"specimen", "middle", "high"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double z = element_centroid(mesh, e)[1];
    mesh.element_region[e] = z < 0.5 ? 0 : (z < 1.0 ? 1 : 2);
  }
  return mesh;
}

TEST(StillWater, UnderLayersWithSuctionAboveErodesNothing) {
  for (const double modulus : {2e7, 2e9, stiff}) {
    for (const DryPart dry : {DryPart::seepage, DryPart::impervious, DryPart::suction}) {
      Scene scene = layered_scene(modulus);
      scene.boundaries[0].dry = dry;
      expect_still("layers, K " + std::to_string(modulus) + ", above the level " +
                       std::to_string(static_cast<int>(dry)),
                   layered_mesh(), scene);
    }
  }
}

}  // namespace still_water_test
}  // namespace suffuse
