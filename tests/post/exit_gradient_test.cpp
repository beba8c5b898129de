/// Safety at the exit next to a sheet pile of half the depth of a layer, computed by all programs.
/// The gradient there is pi h / (B T) = 0.59907 h / T with B = Beta(1/4, 1/2), by the conformal map
/// cosh(pi z / T).

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "checks/heave_safety.hpp"
#include "post/run_programs.hpp"
#include "tables/boundary_text.hpp"
#include "values/sample.hpp"

namespace suffuse {
namespace exit_gradient_test {

using testing::ScratchFolder;

constexpr double head = 2.0;
constexpr double conductivity = 1e-4;

/// A layer 1 m deep and 12 m long; elements of `size` at the exit next to the pile.
std::string geometry(double size) {
  std::ostringstream text;
  text << "h = " << size << ";\n"
       << "Point(1) = {-6, -1, 0, 0.2}; Point(2) = {6, -1, 0, 0.2}; Point(3) = {6, 0, 0, 0.2};\n"
       << "Point(4) = {0, 0, 0, h}; Point(5) = {-6, 0, 0, 0.2}; Point(6) = {0, -0.5, 0, h / 4};\n"
       << "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};\n"
       << "Line(5) = {5, 1}; Line(6) = {4, 6};\n"
       << "Curve Loop(1) = {1, 2, 3, 4, 5}; Plane Surface(1) = {1}; Curve{6} In Surface{1};\n"
       << "Physical Surface(\"sand\") = {1}; Physical Curve(\"downstream\") = {3};\n"
       << "Physical Curve(\"upstream\") = {4}; Physical Curve(\"pile\") = {6};\n";
  return text.str();
}

std::string scene(const std::string& wall = "") {
  std::ostringstream text;
  text << "name = \"pile\"\nformulation = \"single-point\"\ngeometry.file = \"pile.geo\"\n"
       << "mesh = { size = 1.0, structure = \"free\" }\n"
       << "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
       << "soil.sand = { porosity = 0.4, skeleton_fraction = 0.6, grain_density = 2650.0, "
       << "conductivity = " << conductivity << " }\n"
       << "boundary = [{ on = \"upstream\", head = " << head << ", concentration = 0.0 }, "
       << "{ on = \"downstream\", head = 0.0 }]\nwall = [{ on = \"pile\"" << wall << " }]\n"
       << "initial.flow = \"steady\"\ntime.end = 1.0\noutput.every = 1.0\n"
       << "[[output.section]]\nfrom = [0.0, -1.0]\nto = [0.0, -0.5]\n";
  return text.str();
}

ResultsReader run(const ScratchFolder& scratch, double size) {
  return testing::run_programs(scratch, "pile", scene(), geometry(size));
}

TEST(ExitGradient, BesideASheetPileIsTheExactOne) {
  const double exact = std::numbers::pi * head / std::beta(0.25, 0.5);
  std::array<double, 2> error{};
  for (int i = 0; i < 2; ++i) {
    const ScratchFolder scratch;
    const auto parts = safety_of(run(scratch, i == 0 ? 0.04 : 0.02));
    const auto exit = std::ranges::find(parts, "downstream", &PartSafety::name);
    ASSERT_TRUE(exit->least);
    const double at_pile = exit->least->gradient;
    error[i] = std::abs(at_pile / exact - 1.0);
    std::cout << "exit gradient " << at_pile / head << " h / T, off by " << error[i] << '\n';
    EXPECT_LT(std::abs(exit->least->place[0]), 0.05);
    EXPECT_NEAR(exit->least->safety, 0.6 * 1.65 / at_pile, 1e-9);
  }
  EXPECT_LT(error[1], 0.02);
  EXPECT_LT(error[1], 0.7 * error[0]);
}

/// The same water passes the boundaries of the check and the section under the pile.
TEST(ExitGradient, DischargesAgree) {
  const ScratchFolder scratch;
  const ResultsReader results = run(scratch, 0.04);
  const double section = results.sections().column("discharge").back();
  EXPECT_NEAR(section, conductivity * head / 2.0, 0.02 * section);
  int compared = 0;
  for (const PartSafety& part : safety_of(results)) {
    if (!part.discharge || part.name == "pile") continue;
    EXPECT_NEAR(std::abs(*part.discharge), section, 1e-10 * section) << part.name;
    ++compared;
  }
  EXPECT_EQ(compared, 2);
}

/// Water crosses a leaky pile upwards and leaves the soil farther on.
TEST(ExitGradient, AWallThatLeaksIsNoExit) {
  const ScratchFolder scratch;
  const ResultsReader results =
      testing::run_programs(scratch, "pile", scene(", conductance = 1e-6"), geometry(0.1));
  const auto parts = safety_of(results);
  EXPECT_EQ(std::ranges::find(parts, "pile", &PartSafety::name), parts.end());
  EXPECT_NE(std::ranges::find(parts, "downstream", &PartSafety::name), parts.end());
  // Nor does its water enter or leave the model: the masses in and out are those of the ends.
  const std::string text = boundaries_text(results);
  const auto cells = [&](const std::string& name) {
    std::istringstream line(text.substr(text.find('\n' + name) + 1 + name.size()));
    std::array<double, 2> masses{};
    line >> masses[0] >> masses[1];
    return masses;
  };
  const auto [in, out] = cells("all but walls");
  EXPECT_GT(cells("pile")[0], 0.0);
  EXPECT_EQ(in, cells("upstream")[0]);
  EXPECT_EQ(out, cells("downstream")[1]);
}

/// Water rises through 1 m of soil into a pit with 0.5 m of free water: the bottom of the pit is an
/// exit, with the gradient of the column.
/// Soil lies on a drain and on a well.
TEST(ExitGradient, ADrainWithinTheSoilIsNoExit) {
  const ScratchFolder scratch;
  std::string drained = scene();
  const std::string wall = "wall = [{ on = \"pile\" }]";
  ASSERT_NE(drained.find(wall), std::string::npos);
  drained.replace(drained.find(wall), wall.size(), "well = [{ on = \"pile\", head = -0.2 }]");
  const auto parts = safety_of(testing::run_programs(scratch, "pile", drained, geometry(0.1)));
  EXPECT_EQ(std::ranges::find(parts, "pile", &PartSafety::name), parts.end());
  EXPECT_NE(std::ranges::find(parts, "downstream", &PartSafety::name), parts.end());
}

TEST(ExitGradient, TheBottomOfAPitFullOfWaterIsAnExit) {
  const ScratchFolder scratch;
  const std::string geometry =
      "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};\n"
      "Point(5) = {1, 1.5, 0}; Point(6) = {0, 1.5, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
      "Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};\n"
      "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
      "Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};\n"
      "Physical Surface(\"sand\") = {1}; Physical Surface(\"pit\") = {2};\n"
      "Physical Curve(\"bottom\") = {1}; Physical Curve(\"sides\") = {2, 4, 5, 7};\n"
      "Physical Curve(\"top\") = {6};\n";
  const std::string pit =
      "name = \"pile\"\nformulation = \"single-point\"\ngravity = [0.0, -9.81]\n"
      "geometry.file = \"pile.geo\"\nmesh = { size = 0.2, structure = \"free\" }\n"
      "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
      "soil.sand = { porosity = 0.4, skeleton_fraction = 0.6, grain_density = 2650.0, "
      "conductivity = 1e-3, skeleton = { law = \"elastic\", young = 1e9, poisson = 0.3 } }\n"
      "soil.pit.free = true\n"
      "boundary = [{ on = \"bottom\", fix = \"both\", head = [[0.0, 1.5], [100.0, 2.4]] }, "
      "{ on = \"sides\", fix = \"normal\" }, { on = \"top\", head = 1.5 }]\n"
      "time.end = 1000.0\noutput.every = 1000.0\n";
  const auto parts = safety_of(testing::run_programs(scratch, "pile", pit, geometry));
  const auto bed = std::ranges::find(parts, "pit", &PartSafety::name);
  ASSERT_NE(bed, parts.end());
  // Elements at free water conduct better, as if soil filled them in part.
  EXPECT_NEAR(bed->least->gradient, 0.9, 0.05);
  EXPECT_NEAR(bed->least->safety, 0.6 * 1.65 / 0.9, 0.06);
}

}  // namespace exit_gradient_test
}  // namespace suffuse
