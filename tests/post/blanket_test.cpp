/// Blanket theory of `suffuse-post check`.

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace blanket_test
}  // namespace suffuse
