/// Scenes whose values are probably mistakes: each in tests/data/scenes/doubtful raises the
/// warnings of its .expected file, and no others.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <variant>

#include "case/plausibility.hpp"
#include "case/plausibility_base.hpp"
#include "common/errors.hpp"
#include "geometry.hpp"
#include "scene/soil_grading.hpp"
#include "temporary_folder.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace doubtful_scenes_test {

namespace fs = std::filesystem;

const fs::path folder = fs::path(test::data_folder()) / "scenes/doubtful";

std::vector<std::string> doubtful_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

/// The warnings about a scene, one per line.
std::string warnings_of(const SceneDocument& document) {
  std::string lines;
  const auto add = [&](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) lines += warning + '\n';
  };
  std::visit(
      [&](const auto& geometry) {
        add(plausibility_warnings(document, geometry.mesh));
        add(suction_warnings(document, geometry.mesh));
      },
      build_geometry({.document = document}));
  add(grading_warnings(document));
  return lines;
}

class DoubtfulScene : public testing::TestWithParam<std::string> {};

TEST_P(DoubtfulScene, raises_these_warnings) {
  // Messages contain the path of the scene, so it must be relative.
  fs::current_path(folder);
  const std::string expected = test::read_file(GetParam() + ".expected");
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(warnings_of(read_scene(GetParam() + ".toml")), expected);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DoubtfulScene, testing::ValuesIn(doubtful_scenes()),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

/// Scenes with usual values raise none: a needless warning is as bad as a missing one.
TEST(DoubtfulScene, none_where_the_numbers_are_right) {
  fs::current_path(folder);
  const auto mended = [](const std::string& name, const std::vector<std::string>& overrides) {
    return warnings_of(read_scene(name + ".toml", overrides));
  };
  EXPECT_EQ(mended("table-longer-than-the-run", {"time.end=3456", "output.every=100"}), "");
  EXPECT_EQ(mended("table-in-days", {"time.end=2000", "output.every=100"}), "");
  EXPECT_EQ(
      mended("table-in-days", {R"(boundary[1]={on = "top", head = [[0, 4], [1, 4], [1.001, 6]]})"}),
      "")
      << "a jump at the start is no course";
  EXPECT_EQ(mended("head-in-millimetres", {"boundary[1].head=34"}), "");
  EXPECT_EQ(mended("water-level-in-centimetres", {"initial.water_level=4"}), "");
  EXPECT_EQ(mended("rain-in-millimetres-per-hour", {"boundary[1].rain=1e-3"}), "");
  EXPECT_EQ(mended("rain-in-millimetres-per-hour",
                   {"boundary[1].rain=2e-3", "soil.specimen.conductivity=1e-2"}),
            "");
  EXPECT_EQ(mended("gradation-in-metres", {"soil.specimen.conductivity=1e-7"}), "");
  EXPECT_EQ(mended("fines-of-77-per-cent", {"soil.specimen.skeleton_fraction=0.43"}), "");
  EXPECT_EQ(mended("snapshot-every-second", {"output.every=600"}), "");
  EXPECT_EQ(mended("snapshots-after-the-end",
                   {"output.snapshot_every=3600", "output.failure_every=3600"}),
            "");
  EXPECT_EQ(mended("table-before-the-start", {"boundary[0].head=[[-100, 3], [1, 4]]"}), "");
  EXPECT_EQ(mended("water-in-other-units", {"liquid.bulk_modulus=1e4", "liquid.viscosity=0.1"}),
            "");
  EXPECT_EQ(mended("water-in-other-units", {"liquid.bulk_modulus=inf", "liquid.viscosity=1e-4"}),
            "");
  EXPECT_EQ(mended("gravity-in-millimetres", {"gravity=[0, -1962]"}), "");
  EXPECT_EQ(mended("gravity-in-millimetres", {"gravity=[0, -1.62]"}), "");
  EXPECT_EQ(mended("flux-in-millimetres-per-hour", {"boundary[1].darcy_flux=0.01"}), "");
  EXPECT_EQ(mended("flux-in-millimetres-per-hour", {"soil.specimen.conductivity=[1e-4, 1e-2]"}),
            "");
  EXPECT_EQ(
      mended("flux-in-millimetres-per-hour", {R"(boundary[1]={on = "top", velocity = 0.02})"}), "");
  EXPECT_EQ(mended("size-above-the-model", {"mesh.size=1"}), "");
  EXPECT_EQ(mended("friction-in-radians", {"soil.specimen.skeleton.friction=1.5"}), "");
  EXPECT_EQ(mended("friction-in-radians", {"soil.specimen.skeleton.friction=0"}), "");
  EXPECT_EQ(mended("cohesion-in-kilopascal", {"soil.specimen.skeleton.cohesion=50"}), "");
  EXPECT_EQ(mended("cohesion-in-kilopascal", {"soil.specimen.skeleton.cohesion=0"}), "");
  EXPECT_EQ(mended("head-without-gravity", {"gravity=[0, 0]"}), "");
  EXPECT_EQ(mended("gravity-sideways",
                   {"gravity=[-5, -5]", "boundary[0].head=6", "initial.water_level=6"}),
            "");
  EXPECT_EQ(mended("pressure-in-kilopascal", {"boundary[1].pressure=80"}), "");
  EXPECT_EQ(mended("traction-without-the-water", {"boundary[3].traction=[0, -2.5e4]"}), "");
  EXPECT_EQ(mended("field-below-the-elements", {"soil.specimen.field.correlation=0.8"}), "");
  EXPECT_EQ(mended("load-taken-as-drained", {"time.end=1.3e7", "output.every=1e5"}), "");
  EXPECT_EQ(mended("load-taken-as-drained", {"boundary[3].traction=[[0, 0, 0], [60, 0, -1e4]]"}),
            "");
  EXPECT_EQ(mended("load-taken-as-drained", {"boundary[3].traction=[[0, 0, -1e4], [60, 0, -1e4]]"}),
            "");
}

/// A head below its boundary is right where it is a suction, where it rises to the boundary later,
/// and where it is the level of a reservoir, which may rise to the boundary.
TEST(DoubtfulScene, none_of_low_heads_that_act) {
  fs::current_path(folder);
  const auto warnings = [](const std::vector<std::string>& overrides) {
    return warnings_of(read_scene("head-below-its-boundary.toml", overrides));
  };
  const std::string retention = R"(soil.specimen.retention={model = "gardner", alpha = 1.0})";
  EXPECT_EQ(warnings({"boundary[1].head=4"}), "");
  EXPECT_EQ(warnings({"boundary[1].head=[[0, -7], [60, 4.1]]"}), "");
  EXPECT_EQ(warnings({"boundary[1].reservoir_area=1"}), "");
  EXPECT_EQ(warnings({"boundary[1].dry=suction", retention}), "");
  EXPECT_NE(warnings({retention}), "");
  const std::string impervious = warnings({"boundary[1].dry=impervious"});
  EXPECT_NE(impervious.find("no water stands there, and none crosses it."), std::string::npos)
      << impervious;
  const std::string table = warnings({"boundary[1].head=[[0, -7], [60, 1]]"});
  EXPECT_NE(table.find("boundary[1].head: at most 1 m, and"), std::string::npos) << table;
}

/// Scenes that are run unchanged raise none of these warnings. Scenes that must be refused are
/// skipped.
TEST(DoubtfulScene, none_of_the_workflows_and_the_cases) {
  int scenes = 0;
  for (const char* const part : {"workflows", "tests/cases"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(test::source_folder()) / part)) {
      if (entry.path().extension() != ".toml") continue;
      try {
        const SceneDocument document = read_scene(entry.path().string());
        std::visit(
            [&](const auto& geometry) {
              const auto& mesh = geometry.mesh;
              for (const auto& found :
                   {time_warnings(document, mesh), flow_warnings(document, mesh),
                    soil_warnings(document, mesh)}) {
                EXPECT_EQ(found, std::vector<std::string>{}) << entry.path();
              }
            },
            build_geometry({.document = document}));
        ++scenes;
      } catch (const InputError&) {
        continue;
      }
    }
  }
  EXPECT_GT(scenes, 40);
}

}  // namespace doubtful_scenes_test
}  // namespace suffuse
