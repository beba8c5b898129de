/// Meshes with an almost flat triangle: its round-off must not stop a run.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include "driver/plan.hpp"
#include "formulation/two_phase_model.hpp"
#include "geometry.hpp"
#include "seeding.hpp"

namespace suffuse {
namespace sliver_test {

/// Splits an element in three at a point next to its first edge, from whose ends the point is seen
/// at an angle of `degrees` above the edge.
void add_sliver(Mesh<2>& mesh, int element, double degrees) {
  const auto [a, b, c] = mesh.elements[element];
  const Vector<2> along = mesh.nodes[b] - mesh.nodes[a];
  const Vector<2> up = Vector<2>(-along[1], along[0]);
  const double height = 0.5 * std::tan(degrees * std::numbers::pi / 180.0);
  const auto p = static_cast<int>(mesh.nodes.size());
  mesh.nodes.emplace_back(0.5 * (mesh.nodes[a] + mesh.nodes[b]) + height * up);
  mesh.elements[element] = {a, b, p};
  for (const std::array<int, 3>& part : {std::array{b, c, p}, std::array{c, a, p}}) {
    mesh.elements.push_back(part);
    mesh.element_region.push_back(mesh.element_region[element]);
  }
}

/// A block of soil under air, with water 0.75 m high at its left and 0.25 m high at its right,
/// where seepage leaves above the water.
constexpr const char* dam = R"(formulation = "single-point"
gravity = [0.0, -9.81]
geometry = {shape = "column", width = 1.0, height = 1.0}
mesh = {size = 0.25}
liquid = {density = 1000.0, bulk_modulus = inf, viscosity = 1e-3}
initial = {flow = "steady"}
[soil.specimen]
porosity = 0.4
skeleton_fraction = 0.6
grain_density = 2650.0
conductivity = 1e-3
[[boundary]]
on = "left"
head = 0.75
dry = "impervious"
concentration = 0.0
[[boundary]]
on = "right"
head = 0.25
dry = "seepage"
concentration = 0.0
[time]
end = 1e5
[output]
every = 1e4
)";

struct Flow {
  double out = 0.0;  ///< m3/s
  double residual = 0.0;
};

Flow flow_after(double degrees, int element, double time,
                const std::vector<std::string>& overrides) {
  Case<2> c;
  c.document = parse_scene(dam, "scene.toml", overrides);
  c.mesh = build_geometry_of<2>(c.document).mesh;
  if (degrees > 0.0) add_sliver(c.mesh, element, degrees);
  complete_for_mesh(c.document, 2);
  c.solid_points = seed_solid_points(c.mesh, c.document.scene);
  const std::unique_ptr<TwoPhaseModel<2>> model = make_model(c, make_plan(c, {}));
  Flow result;
  while (model->time() < time) {
    model->advance(time);
    result.residual = std::max(result.residual, std::abs(model->ledger().residual_water));
  }
  result.out = model->history_row(model->flow_state()).flux_out;
  return result;
}

const std::vector<std::vector<std::string>> soils{
    {},
    {R"(soil.specimen.retention={model="van-genuchten", alpha=2.0, n=2.0, residual_saturation=0.05})"},
    {R"(soil.specimen.retention={model="gardner", alpha=2.0, residual_saturation=0.05})"}};

/// Elements at a side with a head, inside, and at the water level.
constexpr std::array<int, 3> split{0, 9, 15};

TEST(Slivers, StillWaterIsStillInThem) {
  for (std::vector<std::string> overrides : soils) {
    overrides.emplace_back("boundary[1].head=0.75");
    for (const char* start :
         {R"(initial.flow="steady")", R"(initial={flow="rest", water_level=0.75})"}) {
      overrides.emplace_back(start);
      for (const double degrees : {0.05, 0.005, 0.001}) {
        for (const int element : split) {
          const Flow flow = flow_after(degrees, element, 1e5, overrides);
          EXPECT_LT(flow.out, 1e-9 * 1e-3) << degrees << " degrees, element " << element;
          EXPECT_LT(flow.residual, 1e-12) << degrees << " degrees, element " << element;
        }
      }
      overrides.pop_back();
    }
  }
}

TEST(Slivers, WaterFlowsAsWithoutThem) {
  for (const std::vector<std::string>& overrides : soils) {
    const Flow plain = flow_after(0.0, 0, 1e5, overrides);
    double off = 0.0;
    for (const double degrees : {0.005, 0.001}) {
      for (const int element : split) {
        const Flow flow = flow_after(degrees, element, 1e5, overrides);
        off = std::max(off, std::abs(flow.out / plain.out - 1.0));
        EXPECT_LT(flow.residual, 1e-12) << degrees << " degrees, element " << element;
      }
    }
    std::cout << "outflow off by " << off << "\n";
    EXPECT_LT(off, 0.01);
  }
}

}  // namespace sliver_test
}  // namespace suffuse
