/// Blanket theory of `suffuse-post check`.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

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

}  // namespace blanket_test
}  // namespace suffuse
