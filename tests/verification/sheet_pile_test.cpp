/// Flow under a sheet pile of zero thickness, through the mesher: a [[wall]] slits the mesh. For a
/// pile of half the depth of an infinite layer, q / (k h) = 1/2.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "geometry.hpp"
#include "model_run.hpp"
#include "seeding.hpp"

namespace suffuse {
namespace sheet_pile_test {

/// A layer 1 m deep and 12 m long; elements of `size` at the foot of the pile, which grow with the
/// distance from it.
std::string geometry(double size) {
  std::ostringstream text;
  text << "h = " << size << ";\n"
       << "Point(1) = {-6, -1, 0, 12 * h}; Point(2) = {6, -1, 0, 12 * h}; Point(3) = {6, 0, 0, 12 "
          "* h};\n"
       << "Point(4) = {0, 0, 0, 6 * h}; Point(5) = {-6, 0, 0, 12 * h}; Point(6) = {0, -0.5, 0, h / "
          "8};\n"
       << "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, "
          "1};\n"
       << "Line(6) = {4, 6};\n"
       << "Curve Loop(1) = {1, 2, 3, 4, 5}; Plane Surface(1) = {1};\n"
       << "Curve{6} In Surface{1};\n"
       << "Physical Surface(\"specimen\") = {1}; Physical Curve(\"right\") = {3};\n"
       << "Physical Curve(\"left\") = {4}; Physical Curve(\"pile\") = {6};\n";
  return text.str();
}

/// q / (k h)
double discharge(double size) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "sheet_pile_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "pile.geo") << geometry(size);
  const std::string scene = R"(
    formulation = "single-point"
    geometry = { file = "pile.geo" }
    mesh = { size = 1.0, structure = "free" }
    liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }
    soil.specimen = { porosity = 0.3, skeleton_fraction = 0.6, grain_density = 2700.0, conductivity = 1e-4 }
    boundary = [{ on = "left", head = 2.0, concentration = 0.0 }, { on = "right", head = 0.0 }]
    wall = [{ on = "pile" }]
    initial.flow = "steady"
    time.end = 1.0
    output.every = 1.0
  )";
  Case<2> c;
  c.document = parse_scene(scene, (folder / "pile.toml").string());
  c.mesh = build_geometry_of<2>(c.document).mesh;
  c.solid_points = seed_solid_points(c.mesh, c.document.scene.points);
  model::ModelRun run(std::move(c));
  std::cout << run.input().mesh.element_count() << " elements: ";
  return run.state().history.flux_in / (1e-4 * 2.0);
}

TEST(SheetPile, OfHalfTheDepthLetsHalfThrough) {
  std::array<double, 2> error{};
  std::array<double, 2> size{0.016, 0.008};
  for (int i = 0; i < 2; ++i) {
    error[i] = std::abs(discharge(size[i]) / 0.5 - 1.0);
    std::cout << "q / (k h) off by " << error[i] << '\n';
  }
  EXPECT_LT(error[1], 5e-3);
  EXPECT_GT(std::log2(error[0] / error[1]), 0.8);
}

}  // namespace sheet_pile_test
}  // namespace suffuse
