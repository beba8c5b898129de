/// Saturated soil that moves under water: what stands on it, and what it starts from.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "moving_soil.hpp"

namespace suffuse {
namespace water_on_moving_soil_test {

constexpr double modulus = 1e7;        // Pa, of soil that cannot move sideways
constexpr double conductivity = 1e-7;  // m/s
constexpr double second = 1000.0 * 9.81 / (conductivity * modulus);  // of T = 1, over 1 m

Scene elastic_column() {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.time.end = 3.0 * second;
  scene.time.tolerance = 1e-4;
  Soil& soil = scene.soils[0];
  soil.porosity = 0.4;
  soil.skeleton_fraction = 0.6;
  soil.conductivity = conductivity;
  soil.skeleton.law = skeleton_law("elastic");
  soil.skeleton.young = modulus;
  return scene;
}

void hold(Scene& scene) {
  for (const char* side : {"left", "right"}) {
    scene.boundaries.push_back(model::fixed_on(side, Fixing::normal));
  }
}

/// A column under 20 m of water swells as a load is taken off: the place of its surface is taken by
/// water, whatever curve it has for suction.
TEST(WaterOnMovingSoil, RetentionChangesNothingWhereSoilStaysFull) {
  constexpr double water = 2e5;
  constexpr double load = 1e5;
  const auto swells = [&](bool has_retention) {
    Scene scene = elastic_column();
    scene.water_level = water / (1000.0 * 9.81);
    if (has_retention) scene.soils[0].retention = model::van_genuchten(2.0, 2.0);
    BoundaryCondition top = model::clean_pressure_on("top", water);
    top.traction =
        VectorFunction{{{0.0, {0.0, -water - load, 0.0}}, {1e-6 * second, {0.0, -water, 0.0}}}};
    scene.boundaries = {top, model::fixed_on("bottom", Fixing::both)};
    hold(scene);
    model::ModelRun run(model::make_case(model::crossed_mesh(2, 10, 0.2, 1.0), scene));
    run.run({0.1 * second});
    const double base = model::pressure_at(run, 0.0);
    const auto end = run.run({3.0 * second}).states.back();
    EXPECT_LT(run.worst_residual(), 1e-12);
    return std::pair(base, end.history.displacement_max);
  };
  const auto [base, rise] = swells(true);
  const auto [expected_base, expected_rise] = swells(false);
  std::cout << "pressure " << base << ", without retention " << expected_base << "; rise " << rise
            << ", " << expected_rise << "\n";
  EXPECT_NEAR(base, expected_base, 4e-3 * load);
  EXPECT_NEAR(rise, expected_rise, 3e-3 * expected_rise);
}

/// Soil under air that the mesh has too retains as soil that ends where the mesh does, and drains
/// as much water when the level under it falls.
TEST(WaterOnMovingSoil, RetainsUnderFreeAirAsAtTheBoundary) {
  const auto water = [&](bool has_air) {
    Scene scene = elastic_column();
    scene.soils[0].conductivity = 1e-6;
    scene.gravity = {0.0, -9.81, 0.0};
    scene.soils[0].retention = model::van_genuchten(0.5, 1.5, 0.1);
    scene.water_level = 0.5;
    BoundaryCondition bottom = model::fixed_on("bottom", Fixing::both);
    bottom.head = TimeFunction{{{0.0, 0.5}, {1e4, 0.0}}};
    scene.boundaries = {bottom};
    hold(scene);
    scene.time.end = 2e6;
    const auto is_soil = [](const Vector<2>& x) { return x[1] < 1.6; };
    const Mesh<2> mesh = has_air ? model::under_water(model::crossed_mesh(2, 10, 0.4, 2.0), is_soil)
                                 : model::crossed_mesh(2, 8, 0.4, 1.6);
    model::ModelRun run(model::make_case(mesh, scene));
    const auto states = run.run({0.0, scene.time.end}).states;
    return std::pair(states[0].ledger.water, states[0].ledger.water - states[1].ledger.water);
  };
  const auto [held, drained] = water(true);
  const auto [expected_held, expected_drained] = water(false);
  std::cout << "water " << held << " kg, without air " << expected_held << "; drained " << drained
            << ", " << expected_drained << "\n";
  EXPECT_NEAR(held, expected_held, 3e-4 * expected_held);
  EXPECT_NEAR(drained, expected_drained, 0.02 * expected_drained);
}

/// The pressure at the base rises soon after the start: with incompressible water too, soil takes
/// its time to swell by half of that pressure over its modulus.
TEST(WaterOnMovingSoil, IncompressibleWaterStartsAtRest) {
  constexpr double rise = 1e4;
  Scene scene = elastic_column();
  BoundaryCondition bottom = model::clean_pressure_on("bottom", 0.0);
  bottom.pressure = TimeFunction{{{0.0, 0.0}, {1e-6 * second, rise}}};
  bottom.fix = Fixing::both;
  scene.boundaries = {model::clean_pressure_on("top", 0.0), bottom};
  hold(scene);
  model::ModelRun run(model::make_case(model::crossed_mesh(2, 10, 0.2, 1.0), scene));
  const auto states = run.run({0.0, 0.05 * second, 3.0 * second}).states;
  std::cout << "rise " << states[1].history.displacement_max << ", "
            << states[2].history.displacement_max << " m\n";
  EXPECT_EQ(states[0].history.displacement_max, 0.0);
  EXPECT_LT(states[1].history.displacement_max, 0.6 * 0.5 * rise / modulus);
  EXPECT_NEAR(states[2].history.displacement_max, 0.5 * rise / modulus,
              0.01 * 0.5 * rise / modulus);
}

/// Water of one pressure everywhere moves no soil, at the edge of a pit at the border neither.
TEST(WaterOnMovingSoil, OfOnePressureMovesNoEdgeOfAPit) {
  Scene scene = elastic_column();
  BoundaryCondition top;
  top.on = "top";
  top.head = TimeFunction{{{0.0, 0.0}, {0.1 * second, 10.0}}};
  scene.boundaries = {top, model::fixed_on("bottom", Fixing::both)};
  hold(scene);
  const auto is_soil = [](const Vector<2>& x) { return x[0] > 0.5 || x[1] < 0.6; };
  model::ModelRun run(
      model::make_case(model::under_water(model::crossed_mesh(10, 10, 1.0, 1.0), is_soil), scene));
  const auto end = run.run({3.0 * second}).states.back();
  std::cout << "displacement " << end.history.displacement_max << " m\n";
  EXPECT_LT(end.history.displacement_max, 1e-5 * 1000.0 * 9.81 * 10.0 / modulus);
}

/// Settlement of a column, m, whose water seeps down through it: tau = E ln J with the effective
/// stress tau/J of the buoyant weight and a head that falls evenly over the present height.
double settlement_by_seepage(double height, double young, double buoyancy, double pressure) {
  constexpr int slices = 2000;
  const double slice = height / slices;
  std::vector<double> stretch(slices, 1.0);
  for (int k = 0; k < 100; ++k) {
    const double present = slice * std::reduce(stretch.begin(), stretch.end());
    double depth = 0.0;
    for (int i = 0; i < slices; ++i) {
      const double weight = buoyancy * slice * (i + 0.5);
      const double stress = weight + pressure * (depth + 0.5 * slice * stretch[i]) / present;
      depth += slice * stretch[i];
      stretch[i] = std::exp((weight - stress * stretch[i]) / young);
    }
  }
  return height - slice * std::reduce(stretch.begin(), stretch.end());
}

/// Soil under 10 m of water sinks through elements as the head below it falls. The water follows
/// its surface, through elements that the soil has left or as free water that fills the room.
TEST(WaterOnMovingSoil, FollowsASurfaceThatSinks) {
  constexpr double young = 1e6;
  constexpr double height = 2.0;
  constexpr double weight = 1000.0 * 9.81;
  const double exact = settlement_by_seepage(height, young, 0.6 * 1650.0 * 9.81, 9.0 * weight);
  for (const bool beside_a_pit : {false, true}) {
    Scene scene = elastic_column();
    scene.gravity = {0.0, -9.81, 0.0};
    scene.water_level = 12.0;
    scene.soils[0].conductivity = 1e-4;
    scene.soils[0].skeleton.young = young;
    scene.time.end = 4000.0;
    scene.time.tolerance = 1e-3;
    BoundaryCondition top;
    top.on = "top";
    top.head = TimeFunction{{{0.0, 12.0}}};
    BoundaryCondition bottom = model::fixed_on("bottom", Fixing::both);
    bottom.head = TimeFunction{{{0.0, 12.0}, {1000.0, 3.0}}};
    scene.boundaries = {top, bottom};
    hold(scene);
    Mesh<2> mesh = model::crossed_mesh(4, 20, 0.4, height);
    if (beside_a_pit) {
      mesh = model::under_water(std::move(mesh),
                                [](const Vector<2>& x) { return x[0] < 0.3 || x[1] < 1.9; });
    }
    model::ModelRun run(model::make_case(std::move(mesh), scene));
    const double settlement = run.run({4000.0}).states.back().history.settlement_max;
    std::cout << "settlement " << settlement << ", exact " << exact << " m\n";
    EXPECT_NEAR(settlement, exact, (beside_a_pit ? 0.03 : 5e-3) * exact);
  }
}

/// Effective stresses are those of the weight and of the seepage, however deep the water is.
TEST(WaterOnMovingSoil, StrainsItAloneWhateverItsDepth) {
  const auto stresses_under = [](double depth) {
    Scene scene = elastic_column();
    scene.gravity = {0.0, -9.81, 0.0};
    scene.water_level = 1.0 + depth;
    scene.soils[0].conductivity = 1e-3;
    scene.soils[0].skeleton.young = 1e6;
    scene.time.end = 40.0;
    BoundaryCondition top;
    top.on = "top";
    top.head = TimeFunction{{{0.0, 1.0 + depth}, {20.0, 2.0 + depth}}};
    BoundaryCondition bottom = model::fixed_on("bottom", Fixing::both);
    bottom.head = TimeFunction{{{0.0, 1.0 + depth}}};
    scene.boundaries = {top, bottom};
    hold(scene);
    model::ModelRun run(model::make_case(model::crossed_mesh(2, 10, 0.2, 1.0), scene));
    const Snapshot snapshot = run.run({40.0}, true).snapshots.back();
    std::vector<double> result;
    const auto stress = std::ranges::find(snapshot.solid, "effective_stress", &Field::name);
    for (std::size_t k = 1; k < stress->values.size(); k += 4) result.push_back(stress->values[k]);
    return result;
  };
  const std::vector<double> shallow = stresses_under(0.0);
  const std::vector<double> deep = stresses_under(20.0);
  const double largest = -*std::ranges::min_element(shallow);
  EXPECT_NEAR(largest, 0.6 * 1650.0 * 9.81 + 1000.0 * 9.81, 0.1 * largest);
  EXPECT_LT(*std::ranges::max_element(shallow), 0.0);
  for (std::size_t p = 0; p < deep.size(); ++p) {
    EXPECT_NEAR(deep[p], shallow[p], 1e-4 * largest) << p;
  }
}

}  // namespace water_on_moving_soil_test
}  // namespace suffuse
