/// Stages of construction: a run with a moving skeleton starts from the end of another, with
/// regions dug out or filled in.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "files/layout.hpp"
#include "results/reader.hpp"
#include "solver/solver_process.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace construction_test {

using test::Outcome;

// A column of dry elastic soil, 2 m of base and 0.5 m of a lift, with room above.
constexpr double young = 1e8;     // Pa; Poisson's ratio is 0
constexpr double base = 2.0;      // m
constexpr double lift = 0.5;      // m
constexpr double gravity = 10.0;  // m/s2
constexpr double porosity = 0.4;
constexpr double grain_density = 2650.0;
constexpr double liquid_density = 1.0;
constexpr double unit_weight =
    gravity * ((1.0 - porosity) * grain_density + porosity * liquid_density);

std::string column(const std::string& soil_of_lift) {
  return R"(formulation = "single-point"
gravity = [0.0, -10.0]
geometry.file = "column.geo"
[mesh]
size = 0.25
structure = "crossed"
[liquid]
density = 1.0
bulk_modulus = inf
viscosity = 1e-3
[soil.base]
porosity = 0.4
skeleton_fraction = 0.6
grain_density = 2650.0
conductivity = 1e-1
[soil.base.skeleton]
law = "elastic"
young = 1e8
poisson = 0.0
[soil.lift]
)" + soil_of_lift +
         R"(
[[boundary]]
on = "floor"
fix = "both"
[[boundary]]
on = "sides"
fix = "normal"
[[boundary]]
on = "sky"
pressure = 0.0
[time]
end = 1.0
[output]
every = 1.0
)";
}

constexpr const char* geometry = R"(
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0};
Point(3) = {1, 2, 0}; Point(4) = {0, 2, 0};
Point(5) = {1, 2.5, 0}; Point(6) = {0, 2.5, 0};
Point(7) = {1, 3, 0}; Point(8) = {0, 3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Line(8) = {5, 7}; Line(9) = {7, 8}; Line(10) = {8, 6};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Curve Loop(3) = {-6, 8, 9, 10}; Plane Surface(3) = {3};
Physical Surface("base") = {1};
Physical Surface("lift") = {2};
Physical Surface("free_above") = {3};
Physical Curve("floor") = {1};
Physical Curve("sides") = {2, 4, 5, 7, 8, 10};
Physical Curve("sky") = {9};
)";

/// Points of the base at the end of a run.
struct BaseAtEnd {
  std::vector<double> height;        ///< m, at the start of the run
  std::vector<double> displacement;  ///< upwards, m
  std::vector<double> stress;        ///< vertical effective stress, Pa
};

BaseAtEnd base_at_end(const std::string& folder) {
  const ResultsReader results(folder);
  const std::size_t last = results.times().size() - 1;
  const std::vector<Vector<2>> places = results.point_positions<2>(last, "solid");
  const Field moved = results.field(last, "solid", "displacement");
  const Field stress = results.field(last, "solid", "effective_stress");
  BaseAtEnd result;
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (places[p][1] > base) continue;
    result.displacement.push_back(moved.values[2 * p + 1]);
    result.height.push_back(places[p][1] - result.displacement.back());
    result.stress.push_back(stress.values[4 * p + 1]);
  }
  return result;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

class Construction : public testing::Test {
 protected:
  /// Runs a scene from the results of another, or from its own start. Returns its results folder.
  [[nodiscard]] std::string run(const std::string& name, const std::string& scene,
                                const std::string& from,
                                const std::vector<std::string>& sets = {}) const {
    const std::string folder = place_.path(name + ".results");
    const Outcome outcome = place_.solve(make(name, scene, from, sets), folder);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return folder;
  }
  [[nodiscard]] std::string make(const std::string& name, const std::string& scene,
                                 const std::string& from, std::vector<std::string> sets) const {
    std::ofstream(place_.path("column.geo")) << geometry;
    sets.emplace_back("name=" + name);
    sets.emplace_back(from.empty() ? "initial.water_level=0.0"
                                   : "initial.from=" + from + ".results");
    return place_.make_case({name, scene, sets});
  }

  test::Workplace place_;
  const std::string with_lift_ = column("like = \"base\"\n");
  const std::string without_lift_ = column("free = true\n");
};

/// Excavation is an unloading by the weight of the lift, (unit weight) x 0.5 m, of soil that cannot
/// move sideways: it rises by q y / E at the height y. Filling brings it back.
TEST_F(Construction, ALiftThatIsDugOutAndFilledInMovesTheBaseUpAndDown) {
  const std::string first = run("first", with_lift_, "");
  const std::string dug = run("dug", without_lift_, "first");
  const std::string filled = run("filled", with_lift_, "dug");
  const double load = unit_weight * lift;
  const BaseAtEnd whole = base_at_end(first);
  const BaseAtEnd up = base_at_end(dug);
  const BaseAtEnd down = base_at_end(filled);
  ASSERT_EQ(up.height.size(), whole.height.size());
  ASSERT_EQ(down.height.size(), whole.height.size());
  for (std::size_t p = 0; p < up.height.size(); ++p) {
    const double rise = load * up.height[p] / young;
    const double most = load * base / young;
    EXPECT_NEAR(whole.displacement[p], 0.0, 1e-6 * most);
    EXPECT_NEAR(up.displacement[p], rise, 5e-3 * most);
    EXPECT_NEAR(down.displacement[p], -rise, 5e-3 * most);
  }
  EXPECT_NEAR(mean(up.stress) - mean(whole.stress), load, 2e-3 * load);
  EXPECT_NEAR(mean(down.stress), mean(whole.stress), 2e-3 * load);
}

TEST_F(Construction, TheAccountsStartWithWhatIsLeft) {
  const Table first = ResultsReader(run("first", with_lift_, "")).ledger();
  const Table dug = ResultsReader(run("dug", without_lift_, "first")).ledger();
  const Table filled = ResultsReader(run("filled", with_lift_, "dug")).ledger();
  const double of_lift = lift * (1.0 - porosity) * grain_density;
  const double solid = first.column("solid").back();
  EXPECT_NEAR(dug.column("solid").front(), solid - of_lift, 1e-12 * solid);
  EXPECT_NEAR(filled.column("solid").front(), solid, 1e-12 * solid);
  const double water = first.column("water").back();
  EXPECT_NEAR(dug.column("water").front(), water + lift * (1.0 - porosity) * liquid_density,
              1e-6 * water);
  for (const Table& ledger : {dug, filled}) {
    for (const char* column : {"residual_water", "residual_grains"}) {
      for (const double residual : ledger.column(column)) EXPECT_LE(std::abs(residual), 1e-12);
    }
  }
}

TEST_F(Construction, ARunWithoutConstructionGoesOn) {
  const std::string first = run("first", without_lift_, "");
  const std::string second = run("second", without_lift_, "first");
  const BaseAtEnd before = base_at_end(first);
  const BaseAtEnd after = base_at_end(second);
  ASSERT_EQ(before.height.size(), after.height.size());
  for (std::size_t p = 0; p < after.height.size(); ++p) {
    EXPECT_NEAR(after.displacement[p], 0.0, 1e-9);
    EXPECT_NEAR(after.stress[p], before.stress[p], 1e-6 * unit_weight * base);
  }
}

/// Soil under its weight that becomes stiffer neither moves nor changes its stress; a lift that is
/// dug out of it then lets it rise by q y / E_oed of the new stiffness.
TEST_F(Construction, SoilOfAnotherStiffnessKeepsItsStress) {
  const BaseAtEnd before = base_at_end(run("first", without_lift_, ""));
  const double most = unit_weight * base * base / young;
  for (const std::vector<std::string>& sets :
       {std::vector<std::string>{"soil.base.skeleton.young=1e9"},
        std::vector<std::string>{"soil.base.skeleton.poisson=0.3"}}) {
    const BaseAtEnd after = base_at_end(run(sets[0], without_lift_, "first", sets));
    ASSERT_EQ(before.height.size(), after.height.size());
    for (std::size_t p = 0; p < after.height.size(); ++p) {
      EXPECT_NEAR(after.displacement[p], 0.0, 1e-6 * most) << sets[0];
      EXPECT_NEAR(after.stress[p], before.stress[p], 1e-5 * unit_weight * base) << sets[0];
    }
  }
  static_cast<void>(run("whole", with_lift_, ""));
  const BaseAtEnd up =
      base_at_end(run("dug", without_lift_, "whole", {"soil.base.skeleton.young=2e8"}));
  for (std::size_t p = 0; p < up.height.size(); ++p) {
    const double rise = unit_weight * lift * up.height[p] / (2.0 * young);
    EXPECT_NEAR(up.displacement[p], rise, 5e-3 * most);
  }
}

TEST_F(Construction, AStageGoesOnAfterAStopToTheSameBits) {
  static_cast<void>(run("first", with_lift_, ""));
  const std::vector<std::string> often{"output.every=0.1", "output.snapshot_every=0.1",
                                       "output.restarts=1000"};
  const std::string whole = run("dug", without_lift_, "first", often);
  const std::string stopped = place_.copy(whole, "stopped");
  test::stop_after_snapshot(stopped, test::snapshots_in(whole) / 2);
  const Outcome outcome = place_.solve(place_.path("dug.case.h5"), stopped, {"--resume"});
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(test::difference(stopped, whole), "");
}

TEST_F(Construction, WhatIsBuiltIsSaid) {
  static_cast<void>(run("first", with_lift_, ""));
  const std::string folder = run("dug", without_lift_, "first");
  EXPECT_NE(test::read_file(folder + "/run.json").find("region \\\"lift\\\" is dug out"),
            std::string::npos);
}

TEST_F(Construction, WhatCannotBeBuiltIsRefused) {
  static_cast<void>(run("first", with_lift_, ""));
  const auto expect = [&](const std::vector<std::string>& sets, const std::string& message) {
    const std::string folder = place_.path("wrong.results");
    const Outcome outcome = place_.solve(make("wrong", with_lift_, "first", sets), folder);
    EXPECT_EQ(outcome.code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
    EXPECT_FALSE(std::filesystem::exists(folder));
  };
  expect({"soil.base.porosity=0.39"}, "soil.base.porosity: got 0.39; expected 0.4, as in ");
  expect({"mesh.size=0.5"}, "whose mesh or solid points differ; expected a run on the same mesh");
}

}  // namespace construction_test
}  // namespace suffuse
