/// Saturated soil that moves under water: what stands on it, and what it starts from.

#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <utility>

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
  EXPECT_NEAR(base, expected_base, 0.01 * load);
  EXPECT_NEAR(rise, expected_rise, 3e-3 * expected_rise);
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

/// Water rises through 1 m of stiff soil into free water: all of the soil resists it, though its
/// surface is smoothed over the elements next to it.
TEST(WaterOnMovingSoil, NoneOfTheResistanceIsLostAtItsSurface) {
  constexpr double rise = 1.0;
  constexpr double exact = conductivity * rise / (1000.0 * 9.81);  // m3/s per m2
  for (const int rows : {7, 14, 28}) {
    Scene scene = elastic_column();
    BoundaryCondition bottom = model::clean_pressure_on("bottom", rise);
    bottom.fix = Fixing::both;
    scene.boundaries = {model::clean_pressure_on("top", 0.0), bottom};
    hold(scene);
    const double width = 2.0 * 1.4 / rows;
    model::ModelRun run(
        model::make_case(model::under_water(model::crossed_mesh(2, rows, width, 1.4),
                                            [](const Vector<2>& x) { return x[1] < 1.0; }),
                         scene));
    const auto end = run.run({3.0 * second}).states.back();
    const double share = end.history.flux_out / (width * exact);
    std::cout << rows << " rows: discharge " << share << " of the exact one\n";
    EXPECT_NEAR(share, 1.0, 1e-4) << rows;
  }
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

}  // namespace water_on_moving_soil_test
}  // namespace suffuse
