/// Level ground that the water outside just reaches: a head equal to the height of the ground is
/// the pressure 0 there, in two and three dimensions, for any rounding of coordinates.

#include <cmath>
#include <string>
#include <vector>

#include "mesh/water_line.hpp"
#include "mesher/temporary_folder.hpp"
#include "scene_run.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace water_line_test {

constexpr double conductivity = 1e-4;  // m/s
constexpr double drop = 0.25;          // m, of the head from the top to the bottom

/// A column of height `height` under the conditions `above` at the top, with a head that is lower
/// by `drop` at the bottom.
std::string column(const std::string& geometry, const std::string& gravity,
                   const std::string& height, const std::string& above) {
  return "formulation = \"single-point\"\ngravity = " + gravity + "\n" + geometry +
         R"([liquid]
density = 1000.0
bulk_modulus = inf
viscosity = 1e-3
[soil.specimen]
porosity = 0.35
skeleton_fraction = 0.65
grain_density = 2650.0
conductivity = 1e-4
[[boundary]]
on = "top"
concentration = 0.0
)" + above +
         "\n[[boundary]]\non = \"bottom\"\nhead = " + std::to_string(std::stod(height) - drop) + R"(
[initial]
flow = "steady"
[time]
end = 1.0
[output]
every = 1.0
)";
}

std::string plane(const std::string& height) {
  return "[geometry]\nshape = \"column\"\nwidth = 0.1\nheight = " + height +
         "\n[mesh]\nsize = 0.05\n";
}

std::string box(const std::string& height) {
  return "[geometry]\nshape = \"box\"\nwidth = 0.1\ndepth = 0.1\nheight = " + height +
         "\n[mesh]\nsize = 0.1\n";
}

/// Discharge, m3/s (2D: m2/s), with `head` at the top and with `pressure = 0.0` there.
template <int Dim>
std::pair<double, double> discharges(const std::string& geometry, const std::string& height,
                                     const std::string& head) {
  const std::string gravity = Dim == 2 ? "[0.0, -9.81]" : "[0.0, 0.0, -9.81]";
  model::SceneRun<Dim> under_head(column(geometry, gravity, height, "head = " + head), {});
  model::SceneRun<Dim> under_pressure(column(geometry, gravity, height, "pressure = 0.0"), {});
  under_head.run_to(1.0);
  under_pressure.run_to(1.0);
  EXPECT_LT(under_head.worst_residual(), 1e-12);
  return {under_head.history().flux_out, under_pressure.history().flux_out};
}

struct Ground {
  const char* name;
  const char* height;  ///< of the ground, m
  const char* head;    ///< m
};

class WaterAtTheGround : public ::testing::TestWithParam<Ground> {};

TEST_P(WaterAtTheGround, flows_as_under_no_pressure_in_two_dimensions) {
  const auto [height, head] = std::pair(GetParam().height, GetParam().head);
  const auto [found, expected] = discharges<2>(plane(height), height, head);
  const double exact = conductivity * drop / std::stod(height) * 0.1;
  EXPECT_NEAR(found, expected, 1e-12 * exact);
  EXPECT_NEAR(found, exact, 1e-5 * exact);
}

TEST_P(WaterAtTheGround, flows_as_under_no_pressure_in_three_dimensions) {
  const auto [height, head] = std::pair(GetParam().height, GetParam().head);
  const auto [found, expected] = discharges<3>(box(height), height, head);
  const double exact = conductivity * drop / std::stod(height) * 0.01;
  EXPECT_NEAR(found, expected, 1e-12 * exact);
  EXPECT_NEAR(found, exact, 1e-5 * exact);
}

INSTANTIATE_TEST_SUITE_P(Heights, WaterAtTheGround,
                         ::testing::Values(Ground{"Exact", "0.5", "0.5"},
                                           Ground{"RoundedUp", "0.30000000000000004", "0.3"},
                                           Ground{"RoundedDown", "0.3", "0.30000000000000004"}),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// 2300 mm become 2.3000000000000003 m.
TEST(WaterAtTheGroundOfAFile, flows_whatever_the_scale_rounds) {
  const test::TemporaryFolder folder;
  folder.write("column.geo",
               "Point(1) = {0, 0, 0};\nPoint(2) = {1000, 0, 0};\nPoint(3) = {1000, 2300, 0};\n"
               "Point(4) = {0, 2300, 0};\nLine(1) = {1, 2};\nLine(2) = {2, 3};\nLine(3) = {3, 4};\n"
               "Line(4) = {4, 1};\nCurve Loop(1) = {1:4};\nPlane Surface(1) = {1};\n"
               "Physical Surface(\"specimen\") = {1};\nPhysical Curve(\"bottom\") = {1};\n"
               "Physical Curve(\"top\") = {3};\n");
  const std::string geometry = "[geometry]\nfile = \"" + folder.file("column.geo") +
                               "\"\nscale = 0.001\n[mesh]\nsize = 0.5\nstructure = \"free\"\n";
  const auto [found, expected] = discharges<2>(geometry, "2.3", "2.3");
  EXPECT_NEAR(found, expected, 1e-12 * expected);
  EXPECT_NEAR(found, conductivity * drop / 2.3, 1e-5 * expected);
}

/// The ground of tests/cases/head-level.toml under heads at its two levels, and at zero pressure.
TEST(GroundOfTwoLevels, flows_from_the_upper_to_the_lower) {
  const std::string folder = test::source_folder() + "/tests/cases/";
  const std::vector<std::string> file{"geometry.file=\"" + folder + "a.geo\""};
  std::string text = test::read_file(folder + "head-level.toml");
  model::SceneRun<2> under_heads(text, file);
  for (const std::string head : {"head = 2.0", "head = 1.0"}) {
    text.replace(text.find(head), head.size(), "pressure = 0.0");
  }
  model::SceneRun<2> under_pressures(text, file);
  under_heads.run_to(1.0);
  under_pressures.run_to(1.0);
  const double expected = under_pressures.history().flux_out;
  EXPECT_GT(expected, 1e-5);
  EXPECT_NEAR(under_heads.history().flux_out, expected, 1e-12 * expected);
  EXPECT_NEAR(under_heads.history().flux_in, expected, 1e-12 * expected);
}

/// Half of this slope is in air: faces whose centres are above the level are unchanged, and so is
/// one whose centre is at the level, as a part of that face is above it.
TEST(SlopeAtTheWater, is_wet_below_the_level_alone) {
  Mesh<2> mesh;
  mesh.nodes = {{0.0, 0.0}, {3.0, 0.0}, {0.0, 3.0}};
  const WaterLine<2> line(mesh, {0.0, -9.81, 0.0}, largest_coordinate(mesh));
  EXPECT_EQ(line.wet_above({1, 2}), 1.5);
  EXPECT_LT(line.wet_above({0, 1}), 0.0);
  EXPECT_GT(line.wet_above({0, 1}), -1e-11);
}

}  // namespace water_line_test
}  // namespace suffuse
