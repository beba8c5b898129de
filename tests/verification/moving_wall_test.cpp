/// Walls and wells in soil that moves: they stand still, and the soil slides along them.

#include <gtest/gtest.h>

#include <iostream>

#include "physics/skeleton/skeleton_law.hpp"
#include "scene_run.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace moving_wall_test {

constexpr double young = 1e7;  // Pa
constexpr double poisson = 0.3;
constexpr double oedometer = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));

/// Soil on a smooth box under loads on the halves of its top, Pa, drained long before the end.
std::string loaded_box(double left, double right, const std::string& inside) {
  const auto top = [](const std::string& side, double load) {
    return "[[boundary]]\non = \"top_" + side +
           "\"\npressure = 0.0\nconcentration = 0.0\ntraction = [[0.0, 0.0, 0.0], [1.0, 0.0, " +
           std::to_string(-load) + "]]\n";
  };
  return R"(
formulation = "single-point"
[geometry]
file = ")" +
         test::data_folder() + R"(/geometry/divided.geo"
[mesh]
size = 0.25
[liquid]
density = 1000.0
bulk_modulus = inf
viscosity = 1e-3
[soil.specimen]
porosity = 0.3
skeleton_fraction = 0.7
grain_density = 2700.0
conductivity = 1e-2
skeleton = {law = "elastic", young = 1e7, poisson = 0.3}
[[boundary]]
on = "bottom"
fix = "both"
[[boundary]]
on = "sides"
fix = "normal"
)" + top("left", left) +
         top("right", right) + inside +
         "[initial]\nflow = \"steady\"\n[time]\nend = 100.0\n[output]\nevery = 100.0\n";
}

/// Settlement of points in the middle of each half over their height, relative to q / E_oed, and
/// the largest sideways displacement of any point over the settlement of the top.
struct Settled {
  double left = 0.0;
  double right = 0.0;
  double sideways = 0.0;
};

Settled settled(double left, double right, const std::string& inside) {
  model::SceneRun<2> run(loaded_box(left, right, inside), {});
  run.run_to(100.0);
  const Snapshot snapshot = run.snapshot();
  const auto moved = std::ranges::find(snapshot.solid, "displacement", &Field::name);
  Settled result;
  std::array<int, 2> count{};
  for (std::size_t p = 0; p < snapshot.solid_positions.size() / 3; ++p) {
    const double x = snapshot.solid_positions[3 * p] - moved->values[2 * p];
    const double y = snapshot.solid_positions[3 * p + 1] - moved->values[2 * p + 1];
    const double share = -moved->values[2 * p + 1] / y * oedometer;
    (x < 1.0 ? result.left : result.right) += share / (x < 1.0 ? left : right);
    ++count[x < 1.0 ? 0 : 1];
    result.sideways = std::max(result.sideways,
                               std::abs(moved->values[2 * p]) * oedometer / std::max(left, right));
  }
  result.left /= count[0];
  result.right /= count[1];
  EXPECT_LT(run.worst_residual(), 1e-12);
  return result;
}

TEST(MovingWall, PartsSoilThatSettlesByItselfOnBothSides) {
  const Settled parted = settled(1e3, 5e3, "[[wall]]\non = \"upper\"\n[[wall]]\non = \"lower\"\n");
  EXPECT_NEAR(parted.left, 1.0, 1e-3);
  EXPECT_NEAR(parted.right, 1.0, 1e-3);
  EXPECT_LT(parted.sideways, 1e-3);
  const Settled joined = settled(1e3, 5e3, "");
  EXPECT_GT(joined.left, 1.1);
  EXPECT_LT(joined.right, 0.95);
  EXPECT_GT(joined.sideways, 0.05);
}

/// Under one load the soil slides along a wall and its end, as if there were none; it may let water
/// through, or be a well.
TEST(MovingWall, DoesNotHinderSoilThatSlidesAlongIt) {
  for (const char* inside :
       {"[[wall]]\non = \"upper\"\n", "[[wall]]\non = \"upper\"\nconductance = 1e-3\n",
        "[[well]]\non = \"lower\"\nrate = 0.0\n", "[[well]]\non = \"lower\"\nhead = 3.0\n"}) {
    const Settled found = settled(3e3, 3e3, inside);
    EXPECT_NEAR(found.left, 1.0, 1e-3) << inside;
    EXPECT_NEAR(found.right, 1.0, 1e-3) << inside;
    EXPECT_LT(found.sideways, 1e-3) << inside;
  }
}

TEST(MovingWall, HoldsSoilThatIsPressedAgainstIt) {
  const Settled found = settled(5e3, 1e3, "[[wall]]\non = \"upper\"\n");
  const Settled without = settled(5e3, 1e3, "");
  EXPECT_GT(found.left, without.left);
  EXPECT_LT(found.sideways, 0.7 * without.sideways);
}

}  // namespace moving_wall_test
}  // namespace suffuse
