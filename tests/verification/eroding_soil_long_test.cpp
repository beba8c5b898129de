/// Soil that erodes until it fails, and an oedometer whose fines erode, in whole runs.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numbers>

#include "moving_soil.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace eroding_soil_long_test {

using model::clean_pressure_on;
using model::fixed_on;
using model::missing_fines;

constexpr double degree = std::numbers::pi / 180.0;

/// Runs until the soil has lost its equilibrium, and returns the time, s. The model keeps its last
/// equilibrium.
double time_of_failure(model::ModelRun& run) {
  const double end = run.input().document.scene.time.end;
  const double erodible = run.model().ledger().erodible;
  try {
    run.run({end});
  } catch (const EquilibriumLost& lost) {
    std::cout << lost.what() << "\n";
    EXPECT_LT(run.worst_residual(), 1e-12);
    EXPECT_NEAR(missing_fines(run.model().ledger(), erodible), 0.0, 1e-12 * erodible);
    return run.model().time();
  }
  ADD_FAILURE() << "the soil has stood until " << end << " s";
  return end;
}

// ------------------------------------------------------------------------------ drained oedometer

/// A load is applied and the soil drains; then its fines leave with the water that rises through
/// it, and the soil becomes softer. Returns the largest error of stretch, porosity and fines left.
template <class Run>
double oedometer_error(int rows, int steps_between) {
  constexpr double loaded = 20.0;  // s: the load is applied, the soil has drained
  constexpr double load = 1e5;
  const auto reference = read_reference("oedometer-eroding.csv");
  Scene scene = model::paper_scene();
  scene.formulation = Run::formulation;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = loaded + reference.back().number("t");
  scene.time.step = reference[1].number("t") / steps_between;
  scene.liquid.bulk_modulus = 2e9;
  Soil& soil = scene.soils[0];
  soil.conductivity = 1.0;
  soil.skeleton = model::elastic_soil(1e6, 0.0);
  soil.skeleton.young = FinesFunction({{1.0, 1e6}, {0.0, 4e5}});
  soil.erosion.law = erosion_law("constant");
  soil.erosion.rate = 1e-3;
  soil.erosion.start = loaded;
  BoundaryCondition top = clean_pressure_on("top", 0.0);
  top.traction = VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {0.75 * loaded, {0.0, -load, 0.0}}}};
  // About three pore volumes pass; their gradient carries 1e-4 of the load.
  BoundaryCondition bottom = model::flux_on("bottom", 1e-2);
  bottom.fix = Fixing::both;
  scene.boundaries = {fixed_on("left", Fixing::normal), fixed_on("right", Fixing::normal), top,
                      bottom};
  Run run(model::make_case(model::crossed_mesh(1, rows, 1.0 / rows, 1.0), scene));
  const LedgerRow first = run.model().ledger();
  double worst = 0.0;
  for (const ReferenceRow& row : reference) {
    const auto moments = run.run({loaded + row.number("t")});
    const LedgerRow& ledger = moments.states.back().ledger;
    const MaterialPoints<2>& points = run.model().solid().soils().points();
    double volume = 0.0;
    for (const double v : points.volume) volume += v;
    const double stretch = volume * rows;
    const double porosity = 1.0 - 0.7 * ledger.solid / first.solid / stretch;
    const double left = ledger.erodible / first.erodible;
    std::cout << "t " << row.number("t") << ": stretch off by "
              << stretch / row.number("stretch") - 1.0 << ", n by " << porosity - row.number("n_L")
              << ", fines left by " << left - row.number("erodible_left") << "\n";
    worst = std::max({worst, std::abs(stretch / row.number("stretch") - 1.0),
                      std::abs(porosity - row.number("n_L")),
                      std::abs(left - row.number("erodible_left"))});
    EXPECT_NEAR(missing_fines(ledger, first.erodible), 0.0, 1e-12 * first.erodible);
  }
  std::cout << rows << " rows: " << worst << ", " << run.steps() << " steps, "
            << run.model().coupled_flow().iterations() << " iterations, correction "
            << run.state().history.solid_correction << "\n";
  EXPECT_LT(run.worst_residual(), 1e-12);
  return worst;
}

TEST(ErodingOedometer, SettlesAsItsFinesGoWithTheWater) {
  // The error is that of the steps, on any mesh.
  const double coarse = oedometer_error<model::ModelRun>(8, 10);
  const double long_steps = oedometer_error<model::ModelRun>(32, 10);
  const double short_steps = oedometer_error<model::ModelRun>(32, 40);
  EXPECT_LT(long_steps, 5e-4);
  EXPECT_NEAR(coarse, long_steps, 0.01 * long_steps);
  EXPECT_GT(std::log2(long_steps / short_steps) / 2.0, 0.9);
}

TEST(ErodingOedometer, TheSameWithLiquidPoints) {
  EXPECT_LT(oedometer_error<model::DoublePointRun>(32, 10), 5e-4);
}

// ------------------------------------------------------------------------------------- upward flow

/// Water rises through sand that erodes evenly: as the sand becomes lighter, it comes closer to
/// floating.
double heave_time(double gradient, double rate, int rows) {
  constexpr double conductivity = 1e-2;
  Scene scene = model::paper_scene();
  scene.gravity = {0.0, -9.81, 0.0};
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.initial_flow = InitialFlow::steady;
  Soil& soil = scene.soils[0];
  soil.skeleton_fraction = 0.5;
  soil.conductivity = conductivity;
  soil.skeleton = model::elastic_soil(1e8, 0.25);
  soil.skeleton.law = skeleton_law("mohr-coulomb");
  soil.skeleton.friction = 35.0;
  soil.erosion.law = erosion_law("constant");
  soil.erosion.rate = rate;
  scene.time.end = 0.2 / rate;
  scene.time.failure = AtFailure::stop;
  BoundaryCondition bottom = model::flux_on("bottom", gradient * conductivity);
  bottom.fix = Fixing::both;
  scene.boundaries = {fixed_on("left", Fixing::normal), fixed_on("right", Fixing::normal),
                      clean_pressure_on("top", 0.0), bottom};
  model::ModelRun run(model::make_case(model::crossed_mesh(2, rows, 2.0 / rows, 1.0), scene));
  return time_of_failure(run);
}

TEST(UpwardFlow, LiftsTheSoilWhenItHasLostEnoughOfItsWeight) {
  constexpr double gradient = 1.0;
  // Erosion is so slow that fines hardly make the liquid heavier.
  constexpr double rate = 1e-6;
  const double porosity = 1.0 - gradient / 1.7;
  const double exact = (porosity - 0.3) / rate;
  const double found = heave_time(gradient, rate, 16);
  std::cout << "heave at " << found << " s, exact " << exact << ": off by " << found / exact - 1.0
            << "\n";
  EXPECT_NEAR(found, exact, 0.01 * exact);
}

// ------------------------------------------------------------------------------------------- slope

/// A piece of an infinite slope with seepage along it, rotated so that its surface is the top of a
/// box: gravity is inclined. Its sides carry the stress of the infinite slope at its limit, row by
/// row (a side's traction is uniform), and the flux k sin(beta) enters and leaves through them.
/// Equilibrium does not determine the normal stress along the slope; it is that at failure with
/// associated flow. The uppermost soil is a load: sand without cohesion would fail under the
/// uniform traction of the highest row. Almost nothing erodes, so weights stay, but friction falls.
struct ErodingSlope {
  static constexpr double slope = 15.0 * degree;
  static constexpr double height = 3.0;         // m
  static constexpr double cover = 1.5;          // of soil that acts as a load on top, m
  static constexpr double erodible = 5e-4;      // of the volume
  static constexpr double duration = 100.0;     // until all erodible fines are gone, s
  static constexpr double conductivity = 1e-3;  // m/s
  static constexpr double first_friction = 35.0;
  static constexpr double last_friction = 20.0;

  static double weight() { return 9.81 * (0.7 * 2700.0 + 0.3 * 1000.0); }
  static double buoyant_weight() { return 9.81 * 0.7 * 1700.0; }
  static double mobilised() { return std::tan(slope) * weight() / buoyant_weight(); }
  static double failure_time() {
    const double friction = std::atan(mobilised()) / degree;
    return duration * (first_friction - friction) / (first_friction - last_friction);
  }

  static double pressure(double depth) { return 9810.0 * std::cos(slope) * depth; }
  static double across(double depth) { return -buoyant_weight() * std::cos(slope) * depth; }
  static double shear(double depth) { return weight() * std::sin(slope) * depth; }
  static VectorFunction constant_traction(double x, double y) {
    return VectorFunction{{{0.0, {x, y, 0.0}}}};
  }

  static BoundaryCondition side(const std::string& name, double depth, double sign) {
    const double m = mobilised();
    BoundaryCondition b = model::flux_on(name, -sign * conductivity * std::sin(slope));
    b.traction = constant_traction(sign * (across(depth) * (1.0 + 2.0 * m * m) - pressure(depth)),
                                   sign * shear(depth));
    return b;
  }
  static Case<2> make(int rows) {
    Mesh<2> mesh = model::crossed_mesh(rows, rows, 2.0, height);
    Scene scene = model::paper_scene();
    scene.gravity = {9.81 * std::sin(slope), -9.81 * std::cos(slope), 0.0};
    scene.time.scheme = FlowScheme::implicit_mixed;
    scene.time.end = duration;
    scene.time.failure = AtFailure::stop;
    scene.initial_flow = InitialFlow::steady;
    BoundaryCondition top = clean_pressure_on("top", pressure(cover));
    top.traction = constant_traction(shear(cover), across(cover) - pressure(cover));
    scene.boundaries = {top, fixed_on("bottom", Fixing::both)};
    const std::vector<BoundarySet<2>> sets = mesh.boundaries;
    for (const BoundarySet<2>& set : sets) {
      if (set.name != "left" && set.name != "right") continue;
      for (std::size_t row = 0; row < set.faces.size(); ++row) {
        const std::string name = set.name + std::to_string(row);
        mesh.boundaries.push_back({name, {set.faces[row]}});
        const double y =
            0.5 * (mesh.nodes[set.faces[row][0]][1] + mesh.nodes[set.faces[row][1]][1]);
        scene.boundaries.push_back(side(name, cover + height - y, set.name == "left" ? -1.0 : 1.0));
      }
    }
    std::erase_if(mesh.boundaries, [](const BoundarySet<2>& set) {
      return set.name == "left" || set.name == "right";
    });
    Soil& soil = scene.soils[0];
    soil.skeleton_fraction = 0.7 - erodible;
    soil.conductivity = conductivity;
    soil.erosion.law = erosion_law("constant");
    soil.erosion.rate = erodible / duration;
    soil.skeleton = model::elastic_soil(1e8, 0.3);
    soil.skeleton.law = skeleton_law("mohr-coulomb");
    soil.skeleton.friction = FinesFunction({{1.0, first_friction}, {0.0, last_friction}});
    soil.skeleton.dilation = soil.skeleton.friction;
    return model::make_case(std::move(mesh), scene);
  }
};

TEST(InfiniteSlope, FailsWhenItsFrictionHasFallenWithItsFines) {
  model::ModelRun run(ErodingSlope::make(12));
  const double found = time_of_failure(run);
  const double exact = ErodingSlope::failure_time();
  std::cout << "slope fails at " << found << " s, exact " << exact << ": off by "
            << found / exact - 1.0 << ", " << run.steps() << " steps\n";
  EXPECT_NEAR(found, exact, 0.01 * exact);
}

}  // namespace eroding_soil_long_test
}  // namespace suffuse
