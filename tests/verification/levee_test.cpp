/// A levee in two dimensions with many processes at once: wetting and draining, a flood that rises
/// and falls, seepage faces that open and close, rain, a well, erosion by two laws. A levee of soil
/// that moves: in a steady flow, and in other axes.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <iostream>

#include <fstream>
#include <numbers>

#include "model_run.hpp"
#include "scene_run.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace levee_test {

constexpr double end = 4e5;  // s

BoundaryCondition on(const std::string& name) {
  BoundaryCondition b;
  b.on = name;
  b.concentration = 0.0;
  return b;
}

/// 2 m high, crest 1 m, slopes 1:2; a drain at half its base.
Mesh<2> levee_mesh() {
  constexpr int columns = 28;
  Mesh<2> mesh = model::column_mesh(columns, 12, 1.0, 2.0, [](const Vector<2>& x) {
    return Vector<2>(std::lerp(2.0 * x[1], 9.0 - 2.0 * x[1], x[0]), x[1]);
  });
  mesh.region_names = {"specimen", "core"};
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Vector<2> x = element_centroid(mesh, e);
    mesh.element_region[e] = std::abs(x[0] - 4.5) < 0.6 ? 1 : 0;
  }
  // The right half of the bottom is a well beneath the landside.
  BoundarySet<2> drain{"drain", {}};
  std::erase_if(mesh.boundaries[1].faces, [&](const auto& face) {
    const bool inside = mesh.nodes[face[0]][0] > 7.0 && mesh.nodes[face[0]][0] < 8.0;
    if (inside) drain.faces.push_back(face);
    return inside;
  });
  mesh.boundaries.push_back(drain);
  return mesh;
}

Scene levee_scene(double bulk_modulus, TimeStepping stepping) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = stepping;
  scene.time.end = end;
  scene.liquid.bulk_modulus = bulk_modulus;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.water_level = 0.2;
  Soil& shell = scene.soils[0];
  shell.conductivity = 1e-4;
  shell.conductivity_across = 2e-5;
  shell.bedding = 10.0;
  shell.retention = model::van_genuchten(3.0, 2.0);
  shell.erosion.law = erosion_law("flux");
  shell.erosion.rate = 2.0;
  Soil core = shell;
  core.region = "core";
  core.conductivity = 1e-6;
  core.conductivity_across = unset;
  core.bedding = 0.0;
  core.retention = model::gardner(1.0, 0.15);
  core.erosion.law = erosion_law("first-order");
  core.erosion.rate = 1e-6;
  core.conductivity_law = conductivity_law("kozeny-carman");
  scene.soils.push_back(core);

  BoundaryCondition flood = on("left");
  flood.head = TimeFunction({{0.0, 0.2}, {5e4, 1.8}, {1.5e5, 1.8}, {2.5e5, 0.2}, {end, 0.9}});
  flood.concentration = 0.01;
  BoundaryCondition landside = on("right");
  landside.seepage_face = true;
  BoundaryCondition crest = on("top");
  crest.rain = TimeFunction({{0.0, 0.0}, {1e5, 2e-6}, {3e5, 2e-4}, {end, 0.0}});
  BoundaryCondition drain = on("drain");
  drain.rate = TimeFunction({{0.0, 0.0}, {2e5, -2e-6}});
  scene.boundaries = {flood, landside, crest, drain};
  return scene;
}

/// Whether water left through each boundary, and how often a seepage face opened or closed.
struct Course {
  std::vector<double> porosity;
  FinesState<2> fines;
  LedgerRow ledger;
  std::vector<double> pressure;
  std::vector<BoundaryRow> boundaries;
  double worst_residual = 0.0;
  int switches = 0;
  long steps = 0;
};

Course run_levee(const Scene& scene, int threads) {
  SolverOptions options;
  options.threads = threads;
  model::ModelRun run(model::make_case(levee_mesh(), scene), options);
  Course course;
  const Grid<2>& grid = run.model().grid();
  std::vector<bool> open(grid.face_count(), false);
  for (int part = 1; part <= 40; ++part) {
    const auto moments = run.run({end * part / 40});
    const FlowState<2>& flow = moments.flows.back();
    for (int f = 0; f < grid.face_count(); ++f) {
      if (!grid.is_outer(f)) continue;
      const bool lets_out = flow.face_pressure[f] == 0.0;
      if (lets_out != open[f]) ++course.switches;
      open[f] = lets_out;
    }
    course.pressure = flow.face_pressure;
  }
  course.porosity = run.model().solid().porosity();
  course.fines = run.model().liquid();
  course.ledger = run.model().ledger();
  course.boundaries = run.model().boundary_rows(run.model().flow_state());
  course.worst_residual = run.worst_residual();
  course.steps = run.steps();
  for (const PassTiming& pass : run.model().passes()) {
    if (pass.name == "flow, systems solved") {
      std::cout << run.steps() << " steps, " << pass.calls << " systems solved, residual "
                << course.worst_residual << ", " << course.switches
                << " openings and closings, eroded " << course.ledger.eroded << " kg\n";
    }
  }
  return course;
}

bool same_bits(const std::vector<double>& one, const std::vector<double>& other) {
  return one.size() == other.size() &&
         std::memcmp(one.data(), other.data(), one.size() * sizeof(double)) == 0;
}

TEST(Levee, KeepsItsMassesWhateverHappens) {
  constexpr double stiff = std::numeric_limits<double>::infinity();
  for (const double modulus : {2e7, 2e9, stiff}) {
    for (const auto stepping : {TimeStepping::second_order, TimeStepping::monotone}) {
      SCOPED_TRACE(modulus);
      const Course course = run_levee(levee_scene(modulus, stepping), 1);
      EXPECT_LT(course.worst_residual, 1e-12);
      EXPECT_GT(course.switches, 10);
      EXPECT_GT(course.ledger.eroded, 0.1);
      ASSERT_EQ(course.boundaries.size(), 4u);
      EXPECT_GT(course.boundaries[0].liquid_in, 0.1);    // the flood enters
      EXPECT_GT(course.boundaries[0].liquid_out, 0.01);  // and leaves
      EXPECT_GT(course.boundaries[1].liquid_out, 0.0);
      EXPECT_EQ(course.boundaries[1].liquid_in, 0.0);
      EXPECT_GT(course.boundaries[2].liquid_in, 0.0);
      EXPECT_NEAR(course.boundaries[3].liquid_out, 2e-6 * (0.5 * 2e5 + 2e5), 5e-3 * 0.6);
      double in = 0.0;
      double out = 0.0;
      for (const BoundaryRow& row : course.boundaries) {
        in += row.water_in;
        out += row.water_out;
      }
      EXPECT_NEAR(in, course.ledger.water_in, 1e-12 * in);
      EXPECT_NEAR(out, course.ledger.water_out, 1e-12 * in);
    }
  }
}

TEST(Levee, HasTheSameBitsOnTwoThreads) {
  const Scene scene = levee_scene(2e9, TimeStepping::monotone);
  const Course one = run_levee(scene, 1);
  const Course two = run_levee(scene, 2);
  EXPECT_EQ(one.steps, two.steps);
  EXPECT_TRUE(same_bits(one.porosity, two.porosity));
  EXPECT_TRUE(same_bits(one.pressure, two.pressure));
  for (std::size_t e = 0; e < one.fines.fines_volume.size(); ++e) {
    ASSERT_EQ(one.fines.fines_volume[e], two.fines.fines_volume[e]);
    ASSERT_EQ(one.fines.liquid_volume[e], two.fines.liquid_volume[e]);
  }
}

/// The levee of the example that slides, on coarse elements.
Case<2> sliding_levee(std::vector<std::string> overrides) {
  const std::string folder = test::source_folder() + "/workflows/examples/slide/";
  std::ifstream scene(folder + "slide.toml");
  overrides.insert(overrides.end(), {"geometry.file=\"" + folder + "levee.geo\"", "mesh.size=1.0"});
  return model::case_of<2>(std::string(std::istreambuf_iterator<char>(scene), {}), overrides);
}

/// A second under a level that stands for ever, with tan(friction) and cohesion divided by
/// `reduction`.
HistoryRow after_a_second(double reduction) {
  const double radian = std::numbers::pi / 180.0;
  const double friction = std::atan(std::tan(34.0 * radian) / reduction) / radian;
  const std::string skeleton = "soil.levee.skeleton.";
  model::ModelRun run(
      sliding_levee({"boundary[0].head=2.6", "initial.flow=\"steady\"", "time.end=1.0",
                     skeleton + "friction=" + std::to_string(friction),
                     skeleton + "cohesion=" + std::to_string(4e3 / reduction)}));
  return run.run({1.0}).states.back().history;
}

// Its factor of safety by strength reduction is 1.57.
TEST(Levee, StandsInItsSteadyFlowAsItsFactorSays) {
  const HistoryRow stands = after_a_second(1.5);
  EXPECT_EQ(stands.failure_time, 0.0);
  EXPECT_EQ(stands.inertia, 0.0);
  EXPECT_LT(stands.displacement_max, 1e-5);
  EXPECT_NEAR(stands.flux_out / stands.flux_in, 1.0, 1e-3);
  EXPECT_GT(after_a_second(1.65).inertia, 0.0);
}

/// The case with its mesh and its gravity turned by `angle` about the origin. The mesh and all
/// levels of water are then raised by `lift`, m.
Case<2> in_other_axes(Case<2> c, double angle, double lift) {
  const Eigen::Rotation2Dd turn(angle);
  const Vector<2> up = turn * Vector<2>(0.0, 1.0);
  for (Vector<2>& x : c.mesh.nodes) x = turn * x + lift * up;
  Scene& scene = c.document.scene;
  for (int d = 0; d < 2; ++d) scene.gravity[d] = -9.81 * up[d];
  *scene.water_level += lift;
  for (BoundaryCondition& b : scene.boundaries) {
    if (!b.head) continue;
    for (auto& [t, head] : b.head->knots) head += lift;
  }
  return c;
}

/// A flood in unsaturated soil that erodes and moves has the same results in other axes.
TEST(Levee, IsTheSameInOtherAxes) {
  constexpr double end_of_rise = 4000.0;
  const Case<2> upright =
      sliding_levee({"boundary[0].head=[[0.0, -0.3], [4000.0, 2.6]]", "time.end=4000.0"});
  const auto run = [&](Case<2> c) {
    model::ModelRun model(std::move(c));
    const auto state = model.run({end_of_rise}).states.back();
    EXPECT_LT(model.worst_residual(), 1e-12);
    return std::array{state.history.flux_in, state.history.displacement_max, state.ledger.water,
                      state.ledger.fines_out + state.ledger.fines};
  };
  const auto expected = run(upright);
  const auto found = run(in_other_axes(upright, 0.65, 50.0));
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_GT(expected[k], 0.0);
    EXPECT_NEAR(found[k], expected[k], 1e-6 * expected[k]);
  }
}

}  // namespace levee_test
}  // namespace suffuse
