/// Soil that consolidates: its skeleton moves as water leaves its pores.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "large_strain.hpp"
#include "moving_soil.hpp"
#include "physics/skeleton/soil_element.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace consolidation_test {

constexpr double young = 1e7;             // Pa
constexpr double conductivity = 1e-6;     // m/s
constexpr double weight = 1000.0 * 9.81;  // of water, N/m3

using model::Deviation;
using model::fixed_on;
using model::pressure_at;

/// A column that drains at its top, where a load is applied at once; rigid soil may lie below it.
template <class Run = model::ModelRun>
class Column {
 public:
  Column(int rows, double poisson, double load, double bulk_modulus, double tolerance = 1e-3,
         int rigid_rows = 0)
      : oedometer_(SkeletonParameters{young, poisson}.oedometer_modulus()),
        load_(load),
        run_(make(rows, poisson, bulk_modulus, tolerance, rigid_rows)) {}

  /// The time, s, at which c_v t / H2 = T.
  [[nodiscard]] double time_of(double T) const { return T * weight / (conductivity * oedometer_); }
  [[nodiscard]] Run& run() { return run_; }
  [[nodiscard]] double oedometer() const { return oedometer_; }

 private:
  Case<2> make(int rows, double poisson, double bulk_modulus, double tolerance,
               int rigid_rows) const {
    Scene scene = model::paper_scene();
    scene.formulation = Run::formulation;
    scene.time.scheme = FlowScheme::implicit_mixed;
    scene.time.tolerance = tolerance;
    scene.time.end = 2.0 * time_of(1.0);
    scene.liquid.bulk_modulus = bulk_modulus;
    Soil& soil = scene.soils[0];
    soil.conductivity = conductivity;
    soil.skeleton.law = skeleton_law("elastic");
    soil.skeleton.young = young;
    soil.skeleton.poisson = poisson;
    BoundaryCondition top = model::pressure_on("top", 0.0);
    top.concentration = 0.0;
    top.traction = model::sudden_traction({0.0, -load_}, scene.time.end);
    scene.boundaries = {top, fixed_on("bottom", Fixing::both), fixed_on("left", Fixing::normal),
                        fixed_on("right", Fixing::normal)};
    const double width = 2.0 / rows;
    const double below = static_cast<double>(rigid_rows) / rows;
    Mesh<2> mesh = model::crossed_mesh(2, rows + rigid_rows, width, 1.0 + below);
    for (Vector<2>& x : mesh.nodes) x[1] -= below;
    if (rigid_rows > 0) {
      Soil rigid = soil;
      rigid.region = "rock";
      rigid.skeleton = {};
      scene.soils.push_back(rigid);
      mesh.region_names.emplace_back("rock");
      for (int e = 0; e < mesh.element_count(); ++e) {
        if (element_centroid(mesh, e)[1] < 0.0) mesh.element_region[e] = 1;
      }
      scene.boundaries.erase(scene.boundaries.begin() + 1);  // the rigid soil supports the soil
    }
    return model::make_case(std::move(mesh), scene);
  }

  double oedometer_;
  double load_;
  Run run_;
};

/// Largest differences from Terzaghi's solution from T = 0.1 on, relative to the final settlement
/// and the first pressure.
template <class Run>
Deviation deviation_from_terzaghi(int rows, double poisson, double tolerance, int rigid_rows = 0) {
  constexpr double load = 1e3;
  Column<Run> column(rows, poisson, load, 2e9, tolerance, rigid_rows);
  const double first = load / (1.0 + 0.3 * column.oedometer() / 2e9);
  const double last = load / column.oedometer();
  double below = 1.0;
  for (int p = 0; p < column.run().input().solid_points.size(); ++p) {
    const Vector<2> x = column.run().input().solid_points.position(column.run().input().mesh, p);
    below = std::min(below, 1.0 - x[1]);
  }
  Deviation worst;
  for (const ReferenceRow& row : read_reference("terzaghi.csv")) {
    const double T = row.number("T");
    if (T < 0.1 || T > 1.0) continue;
    const auto moments = column.run().run({column.time_of(T)});
    // The highest points lie below the surface, which drains: the soil in between has its final
    // strain.
    const double settlement = moments.states.back().history.settlement_max + last * below;
    const double elastic = last * (1.0 - first / load);
    const double exact = elastic + (last - elastic) * row.number("U");
    worst.settlement = std::max(worst.settlement, std::abs(settlement - exact) / last);
    for (const double depth : {0.25, 0.5, 0.75}) {
      std::ostringstream name;
      name << "u(" << depth << ")";
      const double error = pressure_at(column.run(), 1.0 - depth) - first * row.number(name.str());
      worst.pressure = std::max(worst.pressure, std::abs(error) / first);
    }
  }
  EXPECT_LT(column.run().worst_residual(), 1e-12);
  for (int e = 0; e < column.run().input().mesh.element_count(); ++e) {
    if (column.run().input().mesh.element_region[e] == 0) continue;
    EXPECT_NEAR(column.run().model().solid().element_porosity()[e], 0.3, 1e-15);
  }
  std::cout << rows << " rows, nu " << poisson << ", tolerance " << tolerance << ": "
            << column.run().steps() << " steps, "
            << column.run().model().coupled_flow().iterations() << " iterations, settlement "
            << worst.settlement << ", pressure " << worst.pressure << "\n";
  worst.steps = column.run().steps();
  return worst;
}

TEST(Consolidation, TerzaghiColumnWithLiquidPoints) {
  const Deviation off = deviation_from_terzaghi<model::DoublePointRun>(32, 0.3, 2e-4);
  EXPECT_LT(off.settlement, 5e-3);
  EXPECT_LT(off.pressure, 5e-3);
}

TEST(Consolidation, TerzaghiColumn) {
  for (const double poisson : {0.0, 0.3}) {
    const Deviation off = deviation_from_terzaghi<model::ModelRun>(32, poisson, 2e-4);
    EXPECT_LT(off.settlement, 5e-3);
    EXPECT_LT(off.pressure, 5e-3);
  }
}

TEST(Consolidation, TerzaghiColumnOnRigidSoil) {
  const Deviation off = deviation_from_terzaghi<model::ModelRun>(32, 0.3, 2e-4, 8);
  EXPECT_LT(off.settlement, 5e-3);
  EXPECT_LT(off.pressure, 5e-3);
}

TEST(Consolidation, StepsAreOfFirstOrder) {
  const Deviation coarse = deviation_from_terzaghi<model::ModelRun>(32, 0.3, 4e-3);
  const Deviation fine = deviation_from_terzaghi<model::ModelRun>(32, 0.3, 2.5e-4);
  const double refinement =
      std::log(static_cast<double>(fine.steps) / static_cast<double>(coarse.steps));
  EXPECT_GT(std::log(coarse.pressure / fine.pressure) / refinement, 0.8);
  EXPECT_GT(std::log(coarse.settlement / fine.settlement) / refinement, 0.8);
}

TEST(Consolidation, LargeStrain) {
  const model::Deviation coarse = model::deviation_at_large_strain("constant", 8, 0.05);
  const model::Deviation fine = model::deviation_at_large_strain("constant", 32, 0.05);
  // 0.0012 and 0.005, or 0.0016 and 0.009: round-off decides how few points leave an element.
  EXPECT_LT(fine.settlement, 0.0018);
  EXPECT_LT(fine.pressure, 0.01);
  EXPECT_LT(fine.height, 5e-5);
  EXPECT_GT(std::log2(coarse.settlement / fine.settlement) / 2.0, 0.55);
  EXPECT_GT(std::log2(coarse.height / fine.height) / 2.0, 1.0);
}

/// A foundation 1e4 times as stiff as the soil under it lets its water drain: forces of soft soil
/// are small compared with those of stiff soil at a significant strain.
TEST(Consolidation, UnderAStiffFoundation) {
  constexpr double load = 1e3;
  constexpr double second = weight / (conductivity * young);  // of T = 1
  Mesh<2> mesh = model::crossed_mesh(4, 32, 0.25, 2.0);
  mesh.region_names = {"specimen", "foundation"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = element_centroid(mesh, e)[1] > 1.0 ? 1 : 0;
  }
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.tolerance = 2e-4;
  scene.time.end = second;
  scene.liquid.bulk_modulus = 2e9;
  scene.soils[0].conductivity = conductivity;
  scene.soils[0].skeleton = model::elastic_soil(young, 0.0);
  scene.soils.push_back(scene.soils[0]);
  scene.soils[1].region = "foundation";
  scene.soils[1].conductivity = 1e4 * conductivity;
  scene.soils[1].skeleton.young = 1e4 * young;
  BoundaryCondition top = model::pressure_on("top", 0.0);
  top.concentration = 0.0;
  top.traction = model::sudden_traction({0.0, -load}, scene.time.end);
  scene.boundaries = {top, fixed_on("bottom", Fixing::both), fixed_on("left", Fixing::normal),
                      fixed_on("right", Fixing::normal)};
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  const double first = load / (1.0 + 0.3 * young / 2e9);
  double worst = 0.0;
  for (const ReferenceRow& row : read_reference("terzaghi.csv")) {
    const double T = row.number("T");
    if (T < 0.1 || T > 1.0) continue;
    run.run({T * second});
    const double error = pressure_at(run, 0.5) / first - row.number("u(0.5)");
    worst = std::max(worst, std::abs(error));
  }
  std::cout << "under a stiff foundation: pressure off by " << worst << ", " << run.steps()
            << " steps, " << run.model().coupled_flow().iterations() << " iterations\n";
  EXPECT_LT(worst, 1e-2);
  EXPECT_LT(run.worst_residual(), 1e-12);
}

TEST(Consolidation, UndrainedLoadGoesToTheWater) {
  constexpr double load = 1e3;
  Column<> column(16, 0.3, load, 2e9);
  column.run().run({column.time_of(1e-6)});
  const double first = load / (1.0 + 0.3 * column.oedometer() / 2e9);
  // Above, the pressures of layers overshoot, because the drained zone is thinner than an element.
  for (const double depth : {0.5, 0.75}) {
    EXPECT_NEAR(pressure_at(column.run(), 1.0 - depth), first, 1e-4 * load);
  }
}

/// Soft clay that consolidates under three times its preconsolidation pressure settles like a soil
/// element with fixed sides, which is another code for the same law, without mesh and water.
TEST(Consolidation, OfCamClaySettlesAsItsElementDoes) {
  constexpr double load = 3e4;
  SkeletonModel clay{.law = skeleton_law("cam-clay"),
                     .young = 2e6,
                     .poisson = 0.3,
                     .friction = 25.0,
                     .compression = 0.05,
                     .preconsolidation = 1e4};
  SoilElement element(clay, PlaneComponents::Zero(), 1.0);
  constexpr int steps = 400;
  for (int k = 1; k <= steps; ++k) {
    ASSERT_EQ(element.advance({.value = {0.0, -load * k / steps, 0.0, 0.0},
                               .is_stress = {false, true, false, false}}),
              1.0);
  }
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.tolerance = 1e-3;
  scene.time.end = 4e5;
  scene.soils[0].conductivity = conductivity;
  scene.soils[0].skeleton = clay;
  BoundaryCondition top = model::pressure_on("top", 0.0);
  top.concentration = 0.0;
  top.traction = VectorFunction{{{0.0, {0.0, 0.0, 0.0}}, {2e5, {0.0, -load, 0.0}}}};
  scene.boundaries = {top, fixed_on("bottom", Fixing::both), fixed_on("left", Fixing::normal),
                      fixed_on("right", Fixing::normal)};
  model::ModelRun run(model::make_case(model::crossed_mesh(2, 16, 0.125, 1.0), scene));
  const auto moments = run.run({scene.time.end});
  EXPECT_LT(run.worst_residual(), 1e-12);
  const double settled = 1.0 - std::exp(element.state().strain[1]);
  const double settlement = moments.states.back().history.settlement_max;
  std::cout << "settlement " << settlement << " of a highest point, of the element " << settled
            << "; " << run.steps() << " steps\n";
  EXPECT_GT(settled, 0.05);
  EXPECT_NEAR(settlement, settled, 0.03 * settled);  // the point lies below the surface
}

}  // namespace consolidation_test
}  // namespace suffuse
