#include "figures/slip_figure.hpp"

#include <gtest/gtest.h>

#include "common/errors.hpp"
#include "post/picture_pixels.hpp"
#include "post/run_programs.hpp"

namespace suffuse {
namespace slip_figure_test {

using testing::file_text;
using testing::make_case_file;
using testing::Pixels;
using testing::run_command;
using testing::ScratchFolder;

/// A bank of 2 m with a slope of 1:1 on 1 m of ground.
constexpr const char* bank_geometry =
    "Point(1) = {0, 0, 0}; Point(2) = {10, 0, 0}; Point(3) = {10, 1, 0}; Point(4) = {6, 1, 0};\n"
    "Point(5) = {4, 3, 0}; Point(6) = {0, 3, 0};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6};\n"
    "Line(6) = {6, 1}; Curve Loop(1) = {1 ... 6}; Plane Surface(1) = {1};\n"
    "Physical Surface(\"bank\") = {1}; Physical Curve(\"base\") = {1};\n"
    "Physical Curve(\"sides\") = {2, 6};\n";

constexpr const char* bank_scene = R"(formulation = "single-point"
gravity = [0.0, -9.81]
geometry.file = "bank.geo"
mesh.size = 0.8
initial.water_level = -1.0
liquid = {density = 1000.0, bulk_modulus = 2e9, viscosity = 1e-3}
time.end = 1.0
output.every = 1.0
[soil.bank]
porosity = 0.35
skeleton_fraction = 0.6
grain_density = 2650.0
conductivity = 1e-5
retention = {model = "gardner", alpha = 10.0}
skeleton = {law = "mohr-coulomb", young = 1e7, poisson = 0.3, friction = 25.0, cohesion = 4e3}
[[boundary]]
on = "base"
fix = "both"
[[boundary]]
on = "sides"
fix = "normal"
)";

/// Writes the mechanism at the factor of safety; returns what the solver says.
std::string write_mechanism(const ScratchFolder& scratch) {
  const std::string file = make_case_file(scratch, "bank", bank_scene, bank_geometry);
  const std::string log = scratch / "said";
  run_command("$PROGRAMS/suffuse-solver " + file + " --strength-reduction --mechanism " +
                  scratch / "slip.hdf" + " > " + scratch / "factor.csv" + " 2> " + log,
              log);
  return file_text(log);
}

/// "1.92" of "at the start: factor of safety 1.92 (holds at ..."
std::string factor_in(const std::string& sentence) {
  const std::string before = "factor of safety ";
  const std::size_t at = sentence.find(before) + before.size();
  return sentence.substr(at, sentence.find(' ', at) - at);
}

TEST(SlipFigure, ShowsWhatSlidesWithItsFactorAndRefusesOtherFiles) {
  const ScratchFolder scratch;
  const std::string said = write_mechanism(scratch);
  draw_slip(scratch / "slip.hdf", scratch / "slip.svg");
  const std::string drawn = file_text(scratch / "slip.svg");
  EXPECT_NE(drawn.find("Slip at the factor of safety " + factor_in(said)), std::string::npos)
      << said;
  for (const auto* text : {"shear strain over the largest motion (1/m)", "of the largest"}) {
    EXPECT_NE(drawn.find(text), std::string::npos) << text;
  }
  draw_slip(scratch / "slip.hdf", scratch / "slip.png");
  const Pixels pixels(scratch / "slip.png");
  // Colours of viridis: the slip surface is yellow, and most of the soil, which rests, is violet.
  int yellow = 0;
  int violet = 0;
  for (int y = 0; y < pixels.height(); ++y) {
    for (int x = 0; x < pixels.width() * 3 / 4; ++x) {
      const auto [red, green, blue] = pixels.at(x, y);
      yellow += red > 200 && green > 200 && blue < 100 ? 1 : 0;
      violet += red < 100 && green < 60 && blue > 60 ? 1 : 0;
    }
  }
  EXPECT_GT(yellow, 100);
  EXPECT_GT(violet, 10 * yellow);
  for (const std::string name : {"bank.case.h5", "bank.toml", "nothing.hdf"}) {
    EXPECT_THROW(draw_slip(scratch / name, scratch / "other.png"), FileError) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(scratch / "other.png"));
}

}  // namespace slip_figure_test
}  // namespace suffuse
