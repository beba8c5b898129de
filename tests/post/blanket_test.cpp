/// Blanket theory of `suffuse-post check`.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "checks/sellmeijer.hpp"
#include "post/check_scenes.hpp"
#include "post/run_programs.hpp"

namespace suffuse {
namespace blanket_test {

using testing::levee_ground;
using testing::levee_scene;
using testing::row_of;
using testing::run_programs;
using testing::ScratchFolder;

std::string blanket(const std::string& more = {}) {
  return "check.blanket = { aquifer = \"sand\", cover = \"clay\", entry = \"river\", "
         "riverside_toe = 0.0, landside_toe = 20.0, riverside = \"closed\", landside = \"closed\"" +
         more + " }\n";
}

/// Share of the head of the river below the cover of `levee_ground` at the landside toe.
double share_of_theory(double aquifer, double cover) {
  const double c = std::sqrt(cover / (aquifer * 10.0 * 2.0));
  const double side = 1.0 / (c * std::tanh(100.0 * c));
  return side / (2.0 * side + 20.0);
}

/// The ground of the levee on 8 m of soil of the region of the cover.
std::string levee_on_deep_clay() {
  std::string ground = levee_ground();
  ground.replace(ground.find("Physical Surface(\"clay\") = {2}"), 30,
                 "Point(9) = {-100, -20, 0}; Point(10) = {120, -20, 0};\n"
                 "Line(10) = {1, 9}; Line(11) = {9, 10}; Line(12) = {10, 2};\n"
                 "Curve Loop(3) = {-1, 10, 11, 12}; Plane Surface(3) = {3};\n"
                 "Physical Surface(\"clay\") = {2, 3}");
  return ground;
}

TEST(Blanket, SoilOfTheCoverBelowTheAquiferIsNoCover) {
  const ScratchFolder scratch;
  const ResultsReader results =
      run_programs(scratch, "levee", levee_scene(blanket()), levee_on_deep_clay());
  const CheckReport report = check_run(results, results.scene().scene.check);
  EXPECT_NEAR(row_of(report, "blanket").effect, share_of_theory(1e-4, 1e-6) * 3.0 / 2.0, 1e-6);
}

/// The river stands on the ground of the landside toe then.
TEST(Blanket, ToesInTheWrongOrderAreRefused) {
  const ScratchFolder scratch;
  const ResultsReader results =
      run_programs(scratch, "levee", levee_scene(blanket()), levee_ground());
  const CheckReport report =
      check_run(results, check_settings(results, {"check.blanket.riverside_toe=20.0",
                                                  "check.blanket.landside_toe=0.0"}));
  ASSERT_EQ(report.refused.size(), 1U);
  EXPECT_NE(report.refused[0].find("check.blanket.landside_toe: got 0 m, with the middle of the "
                                   "boundary \"river\" at x = -50 m; expected the toe that is "
                                   "further from \"river\" than riverside_toe, 20 m"),
            std::string::npos)
      << report.refused[0];
}

/// Water on the land that stands 1e-9 m below the river, as round-off can say.
TEST(Blanket, RoundOffIsNoRiver) {
  const ScratchFolder scratch;
  std::string scene = levee_scene(blanket());
  scene.replace(scene.find("head = 0.0"), 10, "head = 2.999999999");
  const ResultsReader results = run_programs(scratch, "levee", scene, levee_ground());
  const CheckReport report =
      check_run(results, check_settings(results, {"check.blanket.landside_toe=25.0"}));
  const CheckRow& row = row_of(report, "blanket");
  EXPECT_EQ(row.effect, 0.0);
  EXPECT_FALSE(row.factor.has_value());
  EXPECT_TRUE(row.note.starts_with("no river acts")) << row.note;
}

/// The levee with its slopes and its mirror image, with water of 0.5 m on the land: it stands at
/// the toe, though not on the slope.
TEST(Blanket, WaterOnTheLandActsAtTheToeOnBothSides) {
  std::string scene = levee_scene(blanket());
  scene.replace(scene.find("head = 0.0"), 10, "head = 0.5");
  std::string mirrored = levee_scene(blanket());
  mirrored.replace(mirrored.find("head = 3.0"), 10, "head = 0.5");
  mirrored.replace(mirrored.find("head = 0.0"), 10, "head = 3.0");
  const std::string toes = "entry = \"river\", riverside_toe = 0.0, landside_toe = 20.0";
  mirrored.replace(mirrored.find(toes), toes.size(),
                   "entry = \"land\", riverside_toe = 20.0, landside_toe = 0.0");
  std::string ground = levee_ground();
  ground.replace(ground.find("Line(7) = {6, 7};"), 17,
                 "Point(11) = {10, 4, 0}; Line(7) = {6, 11}; Line(13) = {11, 7};");
  ground.replace(ground.find("6, 7, 8, 9}; Plane"), 11, "6, 7, 13, 8, 9}");
  for (const std::string& side : {scene, mirrored}) {
    const ScratchFolder scratch;
    const ResultsReader results = run_programs(scratch, "levee", side, ground);
    const CheckReport report = check_run(results, results.scene().scene.check);
    EXPECT_NEAR(row_of(report, "blanket").effect, share_of_theory(1e-4, 1e-6) * 2.5 / 2.0, 1e-6);
  }
}

/// The computed head in the note of a row, m.
double computed_head(const CheckRow& row) {
  const std::size_t begin = row.note.find("theory, ");
  if (begin == std::string::npos) throw std::runtime_error(row.note);
  return std::stod(row.note.substr(begin + 8));
}

/// Below a cover the head goes on rising while the river stays where it is.
TEST(Blanket, TheComputedHeadIsTheHighestOfAllSnapshots) {
  const ScratchFolder scratch;
  const std::vector<std::string> toe{"check.blanket.landside_toe=20.0"};
  std::string scene = levee_scene(blanket());
  const ResultsReader steady = run_programs(scratch, "levee", scene, levee_ground());
  const double highest =
      computed_head(row_of(check_run(steady, check_settings(steady, toe)), "blanket"));
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(scene.find(from), std::string::npos) << from;
    scene.replace(scene.find(from), from.size(), to);
  };
  const ScratchFolder later;
  replace("bulk_modulus = inf", "bulk_modulus = 2e6");
  replace("initial.flow = \"steady\"", "initial = { flow = \"rest\", water_level = 0.0 }");
  replace("time.end = 1.0\noutput.every = 1.0", "time.end = 1e6\noutput.every = 1e5");
  const ResultsReader rising = run_programs(later, "levee", scene, levee_ground());
  const CheckRow row = row_of(check_run(rising, check_settings(rising, toe)), "blanket");
  EXPECT_NEAR(computed_head(row), highest, 1e-2 * highest);
  EXPECT_LT(row.time, 1e6);
}

/// The scene with pairs of conductivity, and the angle of bedding of both soils.
std::string bedded_scene(const std::string& sand, const std::string& clay, double bedding) {
  std::string scene = levee_scene(
      blanket() +
      "check.backward_erosion = { layer = \"sand\", entry = \"river\", exit = \"land\", "
      "length = 40.0, thickness = 10.0 }\n");
  const std::string angle = "\nbedding = " + std::to_string(bedding);
  scene.replace(scene.find("conductivity = 0.0001"), 21, "conductivity = " + sand + angle);
  scene.replace(scene.find("conductivity = 1e-06"), 20, "conductivity = " + clay + angle);
  return scene;
}

/// Bedding that stands upright, with both conductivities of each soil exchanged, is the same soil
/// as level bedding.
TEST(Blanket, TakesConductivityAlongTheAquiferAndAcrossTheCover) {
  const std::vector<std::pair<std::string, double>> bedded{
      {bedded_scene("[1e-4, 1e-5]", "[1e-5, 1e-6]", 0.0), 0.0},
      {bedded_scene("[1e-5, 1e-4]", "[1e-6, 1e-5]", 90.0), 90.0}};
  for (const auto& [scene, angle] : bedded) {
    const ScratchFolder scratch;
    const ResultsReader results = run_programs(scratch, "levee", scene, levee_ground());
    const CheckReport report = check_run(results, results.scene().scene.check);
    EXPECT_NEAR(row_of(report, "blanket").effect, share_of_theory(1e-4, 1e-6) * 3.0 / 2.0, 1e-6)
        << angle;
    const Gradation& sizes = results.scene().scene.find_soil("sand")->gradation;
    const PipingLayer layer{.length = 40.0,
                            .thickness = 10.0,
                            .d70 = 1e-3 * sizes.size(70.0),
                            .permeability = 1e-4 * 1e-3 / 9810.0,
                            .relative_weight = 1.519649,
                            .uniformity = sizes.size(60.0) / sizes.size(10.0)};
    EXPECT_NEAR(row_of(report, "backward-erosion").resistance, critical_head(layer), 1e-9) << angle;
  }
}

/// Lengths along x are not level then: the same section turned with its gravity has others.
TEST(Blanket, GravityThatIsTiltedIsRefused) {
  const ScratchFolder scratch;
  std::string scene = levee_scene(
      blanket() +
      "check.backward_erosion = { layer = \"sand\", entry = \"river\", exit = \"land\" }\n");
  scene.replace(scene.find("[0.0, -9.81]"), 12, "[0.981, -9.76]");
  const ResultsReader results = run_programs(scratch, "levee", scene, levee_ground());
  const auto refused = [&](const std::vector<std::string>& changes) {
    return check_run(results, check_settings(results, changes)).refused;
  };
  const std::vector<std::string> both = refused({});
  ASSERT_EQ(both.size(), 2U);
  const std::string found = "gravity: got [0.981, -9.76] m/s2; expected gravity along y";
  EXPECT_NE(both[0].find(found + ", which check.blanket takes as upright"), std::string::npos)
      << both[0];
  EXPECT_NE(both[1].find(found + ", or check.backward_erosion.length and thickness"),
            std::string::npos)
      << both[1];
  // Nothing is measured in the drawing then.
  EXPECT_EQ(refused({"check.backward_erosion.length=40.0", "check.backward_erosion.thickness=10.0"})
                .size(),
            1U);
}

/// At 45 degrees a level flux needs (1/k_1 + 1/k_2)/2 of it as its gradient, and an upright
/// gradient drives (k_1 + k_2)/2 of it upwards.
TEST(Blanket, ObliqueBeddingHasBothMeans) {
  const ScratchFolder scratch;
  const ResultsReader results = run_programs(
      scratch, "levee", bedded_scene("[1e-4, 1e-5]", "[1e-6, 1e-7]", 45.0), levee_ground());
  const CheckReport report = check_run(results, results.scene().scene.check);
  EXPECT_NEAR(row_of(report, "blanket").effect,
              share_of_theory(2.0 / (1e4 + 1e5), 0.5 * (1e-6 + 1e-7)) * 3.0 / 2.0, 1e-6);
}

}  // namespace blanket_test
}  // namespace suffuse
