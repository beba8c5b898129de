/// suffuse-solver --strength-reduction: slopes as scenes, through mesher, solver and its table.

#include "tools/strength_table.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "common/hdf5_io.hpp"
#include "files/number_text.hpp"
#include "mesher/temporary_folder.hpp"
#include "results/reader.hpp"
#include "results/vtkhdf.hpp"
#include "scene/scene_schema.hpp"
#include "solver/csv_columns.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace strength_table_test {

using test::Columns;
using test::columns_of;
using test::TemporaryFolder;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double gravity = 9.81;
constexpr double water_weight = 1000.0 * gravity;

/// `pattern` with numbers in place of `%`.
std::string filled(const std::string& pattern, const std::vector<double>& numbers) {
  std::string text;
  std::size_t next = 0;
  for (const char c : pattern) {
    if (c == '%') {
      text += number_text(numbers.at(next++));
    } else {
      text += c;
    }
  }
  return text;
}

/// The programs in a folder of their own.
class Workshop {
 public:
  /// Runs a program in the folder. Returns its exit code.
  int run(const std::string& command) const {
    const std::string line = "cd " + folder_.path().string() + " && " + test::program_folder() +
                             "/" + command + " > out 2> errors";
    return WEXITSTATUS(std::system(line.c_str()));
  }
  /// Meshes a scene into NAME.case.h5.
  void mesh(const std::string& name, const std::string& scene) const {
    folder_.write(name + ".toml", scene);
    ASSERT_EQ(run("suffuse-mesher " + name + ".toml -o " + name + ".case.h5"), 0) << errors();
  }
  void solve(const std::string& name) const {
    ASSERT_EQ(run("suffuse-solver " + name + ".case.h5 --quiet"), 0) << errors();
  }
  /// The table of factors.
  [[nodiscard]] std::string table(const std::string& name, const std::string& options = "") const {
    EXPECT_EQ(run("suffuse-solver " + name + ".case.h5 --strength-reduction " + options), 0)
        << errors();
    return test::read_file(folder_.file("out"));
  }
  [[nodiscard]] Columns factors(const std::string& name, const std::string& options = "") const {
    return columns_of(table(name, options));
  }
  /// The message of a wrong command, after the name of the program.
  [[nodiscard]] std::string refusal(const std::string& arguments, int code = 2) const {
    EXPECT_EQ(run("suffuse-solver " + arguments + " -o a.csv"), code) << errors();
    EXPECT_FALSE(std::filesystem::exists(folder_.file("a.csv")));
    const std::string text = errors();
    const std::string start = "suffuse-solver: error: ";
    return text.starts_with(start) ? text.substr(start.size()) : text;
  }
  [[nodiscard]] std::string errors() const { return test::read_file(folder_.file("errors")); }
  [[nodiscard]] const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

// ------------------------------------------------------------------------ a slope of 2:1, 10 m
// high

constexpr const char* slope_geometry = R"(
Point(1) = {0, 0, 0};
Point(2) = {32, 0, 0};
Point(3) = {12, 10, 0};
Point(4) = {0, 10, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("fill") = {1};
Physical Curve("base") = {1};
Physical Curve("slope") = {2};
Physical Curve("crest") = {3};
Physical Curve("back") = {4};
)";

struct Slope {
  double mesh = 1.0;              ///< m
  double cohesion = 0.0;          ///< Pa
  double grain_density = 2700.0;  ///< kg/m3
  double water_level = -10.0;     ///< m
  std::string more = "";          ///< further text of the scene
};

/// c/(gamma H) of a dry slope, or of one that is saturated and under water.
double cohesion_for(double share, double unit_weight) {
  return share * unit_weight * 10.0;
}

std::string slope_scene(const Slope& slope) {
  return filled(R"(formulation = "single-point"
gravity = [0.0, -9.81]
geometry.file = "slope.geo"
mesh.size = %
initial.water_level = %
liquid = {density = 1000.0, bulk_modulus = 2e9, viscosity = 1e-3}
time.end = 10.0
output.every = 10.0
[soil.fill]
porosity = 0.25
skeleton_fraction = 0.7
grain_density = %
conductivity = 1e-5
retention = {model = "gardner", alpha = 10.0}
[soil.fill.skeleton]
law = "mohr-coulomb"
young = 1e8
poisson = 0.3
friction = 20.0
dilation = 20.0
cohesion = %
[[boundary]]
on = "base"
fix = "both"
[[boundary]]
on = "back"
fix = "normal"
)",
                {slope.mesh, slope.water_level, slope.grain_density, slope.cohesion}) +
         slope.more;
}

constexpr double dry_weight = 0.75 * 2700.0 * gravity;

TEST(StrengthTable, SlopeOfGriffithsAndLane) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  w.mesh("slope", slope_scene({.cohesion = cohesion_for(0.05, dry_weight)}));
  const Columns found = w.factors("slope", "--mechanism slip.hdf");
  std::cout << "factor " << found.at("factor")[0] << std::endl;
  EXPECT_NEAR(found.at("factor")[0], 1.4, 0.05);
  EXPECT_EQ(found.at("t")[0], 0.0);
  EXPECT_EQ(found.at("fines_left")[0], 1.0);
  EXPECT_LT(found.at("fails")[0], 1.01 * found.at("holds")[0]);
  const std::string start = "at the start: factor of safety " + short_text(found.at("factor")[0]) +
                            " (holds at " + short_text(found.at("holds")[0]) + ", fails at " +
                            short_text(found.at("fails")[0]) +
                            "); what fails moves most in soil \"fill\" at (";
  EXPECT_TRUE(w.errors().starts_with(start)) << w.errors();
  // The sliding soil is the slope, outwards at its toe, but neither the back nor the base.
  const Hdf5File file(w.folder().file("slip.hdf"), Hdf5File::Mode::read);
  const std::vector<double> x = file.read_doubles("/VTKHDF/Points");
  const std::vector<double> slip = read_field(file, "/VTKHDF/PointData", "mechanism").values;
  double outwards = 0.0;
  for (std::size_t i = 0; i < slip.size() / 2; ++i) {
    const double size = std::hypot(slip[2 * i], slip[2 * i + 1]);
    EXPECT_LE(size, 1.0 + 1e-12);
    if (x[3 * i] < 6.0) {
      EXPECT_LT(size, 0.1);
    }
    if (x[3 * i] > 14.0 && x[3 * i + 1] > 10.0 - 0.5 * (x[3 * i] - 12.0) - 0.1 && size > 0.0) {
      outwards = std::max(outwards, slip[2 * i]);
    }
  }
  EXPECT_GT(outwards, 0.9);
}

TEST(StrengthTable, SlopeUnderWaterHasTheFactorOfOneThatWeighsAsMuchAsItUnderWater) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  const double buoyant = 0.75 * 1700.0 * gravity;
  Slope slope{.mesh = 2.0, .cohesion = cohesion_for(0.1, buoyant), .water_level = 10.0};
  slope.more = "[[boundary]]\non = \"slope\"\nhead = 10.0\n";
  w.mesh("wet", slope_scene(slope));
  w.mesh("light", slope_scene({.mesh = 2.0, .cohesion = slope.cohesion, .grain_density = 1700.0}));
  const Columns wet = w.factors("wet");
  const Columns light = w.factors("light");
  EXPECT_EQ(wet.at("factor"), light.at("factor"));
  EXPECT_EQ(w.factors("wet", "--quadratic").at("factor"),
            w.factors("light", "--quadratic").at("factor"));
}

TEST(StrengthTable, SlopeOnACoarseMeshWithQuadraticDisplacements) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  w.mesh("slope", slope_scene({.mesh = 2.5, .cohesion = cohesion_for(0.05, dry_weight)}));
  const double linear = w.factors("slope").at("factor")[0];
  const double quadratic = w.factors("slope", "--quadratic --mechanism slip.hdf").at("factor")[0];
  std::cout << "linear " << linear << ", quadratic " << quadratic << std::endl;
  EXPECT_GT(linear, 1.03 * quadratic);
  EXPECT_NEAR(quadratic, 1.4, 0.05);
  const Hdf5File file(w.folder().file("slip.hdf"), Hdf5File::Mode::read);
  EXPECT_EQ(read_field(file, "/VTKHDF/PointData", "mechanism").values.size(),
            2 * file.read_doubles("/VTKHDF/Points").size() / 3);
  EXPECT_EQ(w.refusal("slope.case.h5 --quadratic"),
            "--quadratic requires --strength-reduction (see --help)\n");
}

// --------------------------------------------- soil that fails by itself beside a slope that holds

/// Sand without cohesion in front of the toe, which it touches at one node.
std::string ground_geometry(double thickness) {
  return std::string(slope_geometry) + filled(R"(
Point(5) = {32, %, 0};
Point(6) = {40, %, 0};
Point(7) = {40, 0, 0};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 2};
Line(8) = {2, 5};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(2) = {2};
Physical Surface("ground") = {2};
Physical Curve("below") = {5};
Physical Curve("sides") = {6, 8};
Physical Curve("top") = {7};
)",
                                              {-thickness, -thickness});
}

/// Water flows up through the ground with a gradient of 1.5, which lifts it.
std::string lifted_ground(double thickness) {
  return filled(R"([soil.ground]
porosity = 0.4
skeleton_fraction = 0.6
grain_density = 2700.0
conductivity = 1e-4
[soil.ground.skeleton]
law = "mohr-coulomb"
young = 1e8
poisson = 0.3
friction = 35.0
cohesion = 0.0
[[boundary]]
on = "below"
fix = "both"
head = %
[[boundary]]
on = "sides"
fix = "normal"
[[boundary]]
on = "top"
head = 0.0
[initial]
flow = "steady"
)",
                {1.5 * thickness});
}

TEST(StrengthTable, LeavesOutSoilThatFailsByItself) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  const Slope alone{.mesh = 2.0, .cohesion = cohesion_for(0.05, dry_weight)};
  w.mesh("alone", slope_scene(alone));
  const double expected = w.factors("alone").at("factor")[0];
  const auto lift = [&](const std::string& name, double thickness) {
    w.folder().write("slope.geo", ground_geometry(thickness));
    Slope slope = alone;
    slope.more = lifted_ground(thickness);
    std::string scene = slope_scene(slope);
    const std::string level = "initial.water_level = -10\n";
    scene.replace(scene.find(level), level.size(), "");
    w.mesh(name, scene);
  };
  lift("thin", 0.5);
  EXPECT_TRUE(w.refusal("thin.case.h5 --strength-reduction", 3)
                  .starts_with("at the start: there is no factor of safety"));
  EXPECT_NEAR(w.factors("thin", "--region fill").at("factor")[0], expected, 0.01 * expected);
  // The skin hardly holds a slip 10 m long.
  const double deep =
      w.factors("thin", "--region fill --region ground --deeper 0.6").at("factor")[0];
  EXPECT_NEAR(deep, expected, 0.05 * expected);
  EXPECT_GE(deep, 0.995 * expected);
  // A body thicker than the depth is not left out.
  lift("thick", 4.0);
  EXPECT_TRUE(w.refusal("thick.case.h5 --strength-reduction --deeper 1", 3)
                  .starts_with("at the start: there is no factor of safety"));
  EXPECT_EQ(w.refusal("thick.case.h5 --strength-reduction --region fil"),
            "--region: got \"fil\"; expected a soil with a strength: fill or ground\n");
}

// ------------------------------------------------------------------ sand on sand, dry

/// A fill of dry sand, 12 m high, on ground of the same sand, whose border runs through the toe.
/// Soil without cohesion slides along its slope: F = tan(phi) / tan(beta).
std::string sand_geometry(bool has_air) {
  std::string text = R"(
Point(1) = {-15, -6, 0};
Point(2) = {45, -6, 0};
Point(3) = {45, 0, 0};
Point(4) = {45, 12, 0};
Point(5) = {30, 12, 0};
Point(6) = {0, 0, 0};
Point(7) = {-15, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 1};
Line(8) = {3, 6};
Curve Loop(1) = {1, 2, 8, 6, 7};
Plane Surface(1) = {1};
Curve Loop(2) = {3, 4, 5, -8};
Plane Surface(2) = {2};
Physical Surface("ground") = {1};
Physical Surface("fill") = {2};
Physical Curve("base") = {1};
Physical Curve("right") = {2, 3};
Physical Curve("left") = {7};
)";
  if (!has_air) return text;
  return text + R"(
Point(8) = {-15, 14, 0};
Point(9) = {45, 14, 0};
Line(9) = {4, 9};
Line(10) = {9, 8};
Line(11) = {8, 7};
Curve Loop(3) = {9, 10, 11, -6, -5, -4};
Plane Surface(3) = {3};
Physical Surface("free_above") = {3};
)";
}

std::string sand_scene(double mesh) {
  return filled(R"(formulation = "single-point"
gravity = [0.0, -9.81]
geometry.file = "sand.geo"
mesh = {size = %, structure = "free"}
liquid = {density = 1000.0, bulk_modulus = 2e9, viscosity = 1e-3}
initial.water_level = -6.0
time.end = 1.0
output.every = 1.0
[soil.ground]
porosity = 0.3
skeleton_fraction = 0.65
grain_density = 2650.0
conductivity = 1e-5
retention = {model = "van-genuchten", alpha = 1000.0, n = 3.0}
skeleton = {law = "mohr-coulomb", young = 5e7, poisson = 0.3, friction = 36.0, cohesion = 0.0}
[soil.fill]
like = "ground"
[[boundary]]
on = "base"
fix = "both"
[[boundary]]
on = "left"
fix = "normal"
[[boundary]]
on = "right"
fix = "normal"
)",
                {mesh});
}

/// Patches of triangles at the surface failed by themselves once, at a factor of 1.1. The factor
/// falls to the exact one as the mesh is refined.
TEST(StrengthTable, SlopeOfDrySandOnFreeTriangles) {
  const double exact = std::tan(36.0 * degree) * 30.0 / 12.0;
  const auto error = [&](bool has_air, double size) {
    const Workshop w;
    w.folder().write("sand.geo", sand_geometry(has_air));
    w.mesh("sand", sand_scene(size));
    const double found = w.factors("sand").at("factor")[0];
    std::cout << (has_air ? "below air " : "") << found << ", exact " << exact << "\n";
    return found / exact - 1.0;
  };
  const double coarse = error(false, 1.5);
  const double fine = error(false, 0.8);
  EXPECT_LT(std::abs(coarse), 0.08);
  EXPECT_LT(std::abs(fine), 0.6 * std::abs(coarse));
  EXPECT_NEAR(error(true, 2.0), 0.0, 0.1);
}

/// Weak soil under water between smooth sides stands with any strength: its stress is the same in
/// all directions. Patches with one mean stress each bore its weight by shear stresses once, and
/// failed.
TEST(StrengthTable, LevelGroundStandsWithAnyStrength) {
  const auto scene = [](const std::string& shape, const std::string& downwards,
                        const std::string& law, const std::vector<std::string>& sides) {
    std::string text = "formulation = \"single-point\"\ngravity = " + downwards +
                       "\ngeometry = " + shape + R"(
mesh = {size = 2.0, structure = "free"}
liquid = {density = 1000.0, bulk_modulus = inf, viscosity = 1e-3}
initial.water_level = 8.0
time.end = 1.0
output.every = 1.0
[soil.specimen]
porosity = 0.4
skeleton_fraction = 0.6
grain_density = 2650.0
conductivity = 1e-5
[soil.specimen.skeleton]
young = 2e7
poisson = 0.3
)" + law + R"(
[[boundary]]
on = "bottom"
fix = "both"
)";
    for (const std::string& side : sides) {
      text += "[[boundary]]\non = \"" + side + "\"\nfix = \"normal\"\n";
    }
    return text;
  };
  const std::string plane = "{shape = \"column\", width = 16.0, height = 8.0}";
  const std::string box = "{shape = \"box\", width = 12.0, depth = 6.0, height = 8.0}";
  for (const std::string law : {"law = \"von-mises\"\ncohesion = 500.0",
                                "law = \"mohr-coulomb\"\nfriction = 5.0\ncohesion = 0.0"}) {
    const Workshop w;
    w.mesh("plane", scene(plane, "[0.0, -9.81]", law, {"left", "right"}));
    w.mesh("box", scene(box, "[0.0, 0.0, -9.81]", law, {"left", "right", "front", "back"}));
    EXPECT_GE(w.factors("plane").at("holds")[0], 60.0) << law;
    EXPECT_GE(w.factors("box").at("holds")[0], 60.0) << law;
  }
}

// ------------------------------------------------------------------ the infinite slope with
// seepage

/// A piece of an infinite slope, rotated so that its surface is the top of a box, with water that
/// flows along it. Its sides carry the stress at the limit, in steps of a row; the upper half has
/// cohesion, so that no such step fails by itself. Friction falls with the fines, which leave at a
/// constant rate.
struct InfiniteSlope {
  static constexpr int rows = 6;
  static constexpr double length = 2.0;
  static constexpr double height = 3.0;
  static constexpr double slope = 15.0 * degree;
  static constexpr double porosity = 0.35;
  static constexpr double erodible = 0.01;
  static constexpr double fines_last = 1e5;  ///< s

  static double fines_left(double time) { return 1.0 - time / fines_last; }
  /// \return N/m3
  static double saturated_weight(double left) {
    const double n = porosity + erodible * (1.0 - left);
    return ((1.0 - n) * 2700.0 + n * 1000.0) * gravity;
  }
  /// Factor of safety at a time. `weaker`: degrees of friction that are missing.
  static double exact(double time, double weaker = 0.0) {
    const double left = fines_left(time);
    const double weight = saturated_weight(left);
    const double friction = (28.0 + 7.0 * left - weaker) * degree;
    return std::tan(friction) * (weight - water_weight) / (std::tan(slope) * weight);
  }

  static std::string geometry() {
    std::string text;
    for (int i = 0; i <= rows; ++i) {
      const double y = height * i / rows;
      text += filled("Point(%) = {0, %, 0};\nPoint(%) = {%, %, 0};\n",
                     {1.0 + i, y, 101.0 + i, length, y});
    }
    for (int i = 0; i <= rows; ++i) {
      text += filled("Line(%) = {%, %};\n", {201.0 + i, 1.0 + i, 101.0 + i});
      if (i == rows) continue;
      text += filled("Line(%) = {%, %};\nLine(%) = {%, %};\n",
                     {1.0 + i, 1.0 + i, 2.0 + i, 101.0 + i, 101.0 + i, 102.0 + i});
      text += filled("Physical Curve(\"left%\") = {%};\nPhysical Curve(\"right%\") = {%};\n",
                     {0.0 + i, 1.0 + i, 0.0 + i, 101.0 + i});
    }
    const auto part = [&](int number, int from, int to, const std::string& name) {
      std::string loop = filled("Curve Loop(%) = {%", {0.0 + number, 201.0 + from});
      for (int i = from; i < to; ++i) loop += filled(", %", {101.0 + i});
      loop += filled(", -%", {201.0 + to});
      for (int i = to - 1; i >= from; --i) loop += filled(", -%", {1.0 + i});
      return loop + filled("};\nPlane Surface(%) = {%};\n", {0.0 + number, 0.0 + number}) +
             "Physical Surface(\"" + name + filled("\") = {%};\n", {0.0 + number});
    };
    return text + part(1, 0, rows / 2, "lower") + part(2, rows / 2, rows, "upper") +
           filled("Physical Curve(\"bottom\") = {201};\nPhysical Curve(\"top\") = {%};\n",
                  {201.0 + rows});
  }

  static std::string scene(bool moves, double young = 1e8, double weaker = 0.0) {
    std::string text = filled(R"(formulation = "single-point"
gravity = [%, %]
geometry.file = "infinite.geo"
mesh.size = 0.7
liquid = {density = 1000.0, bulk_modulus = 2e9, viscosity = 1e-3}
initial.flow = "steady"
time.end = 8e4
output.every = 2e4
[soil.lower]
porosity = %
skeleton_fraction = %
grain_density = 2700.0
conductivity = 1e-2
erosion = {law = "constant", rate = 1e-7, start = 0.0}
)",
                              {gravity * std::sin(slope), -gravity * std::cos(slope), porosity,
                               1.0 - porosity - erodible});
    if (moves) {
      text += filled(R"([soil.lower.skeleton]
law = "mohr-coulomb"
young = %
poisson = 0.3
friction = [[1.0, %], [0.0, %]]
cohesion = 0.0
dilation = %
)",
                     {young, 35.0 - weaker, 28.0 - weaker, 28.0 - weaker});
    }
    text += "[soil.upper]\nlike = \"lower\"\n";
    if (moves) text += "skeleton.cohesion = 5e4\n[[boundary]]\non = \"bottom\"\nfix = \"both\"\n";
    text += "[[boundary]]\non = \"top\"\npressure = 0.0\n";
    for (int i = 0; i < rows; ++i) text += sides(i, moves);
    return text;
  }

 private:
  static std::string sides(int row, bool moves) {
    const double depth = height * (1.0 - (row + 0.5) / rows);
    const double weight = saturated_weight(0.5);
    const double mobilised = std::tan(slope) * weight / (weight - water_weight);
    const double across = -(weight - water_weight) * std::cos(slope) * depth;  // effective
    const double along =
        across * (1.0 + 2.0 * mobilised * mobilised) - water_weight * std::cos(slope) * depth;
    const double shear = weight * std::sin(slope) * depth;
    const double head = height * std::cos(slope);
    std::string text;
    for (const bool right : {false, true}) {
      const double sign = right ? 1.0 : -1.0;
      text +=
          "[[boundary]]\non = \"" + std::string(right ? "right" : "left") +
          filled("%\"\nhead = %\n", {0.0 + row, right ? head - length * std::sin(slope) : head});
      if (moves) text += filled("traction = [%, %]\n", {sign * along, sign * shear});
    }
    return text;
  }
};

/// Meshed and run with and without a moving skeleton.
const Workshop& infinite_slope() {
  static const Workshop w;
  static const bool made = [] {
    w.folder().write("infinite.geo", InfiniteSlope::geometry());
    w.mesh("moving", InfiniteSlope::scene(true));
    w.mesh("rigid", InfiniteSlope::scene(false));
    w.solve("moving");
    w.solve("rigid");
    return true;
  }();
  EXPECT_TRUE(made);
  return w;
}

void expect_exact_factors(const Columns& found) {
  ASSERT_EQ(found.at("t"), (std::vector{0.0, 2e4, 4e4, 6e4, 8e4}));
  for (std::size_t k = 0; k < found.at("t").size(); ++k) {
    const double time = found.at("t")[k];
    const double exact = InfiniteSlope::exact(time);
    std::cout << "t = " << time << ": " << found.at("factor")[k] << ", exact " << exact << ", "
              << 100.0 * (found.at("factor")[k] / exact - 1.0) << " %" << std::endl;
    EXPECT_NEAR(found.at("factor")[k], exact, 5e-3 * exact);
  }
}

void expect_exact_fines(const Columns& found) {
  for (std::size_t k = 0; k < found.at("t").size(); ++k) {
    EXPECT_NEAR(found.at("fines_left")[k], InfiniteSlope::fines_left(found.at("t")[k]), 1e-5);
  }
}

/// The law erodes fines per volume of soil, which grows as the slope dilates: in each interval the
/// loss lies between those for the volumes at its ends, which follow from the mean porosity.
void expect_fines_of_the_volume(const Columns& found, const Columns& history) {
  const std::vector<double>& left = found.at("fines_left");
  const auto volume = [&](std::size_t k) {
    const double solid = 1.0 - InfiniteSlope::porosity - InfiniteSlope::erodible * (1.0 - left[k]);
    return solid / (1.0 - history.at("porosity_mean")[k]);
  };
  ASSERT_EQ(history.at("t"), found.at("t"));
  constexpr double round_off = 1e-12;
  for (std::size_t k = 1; k < left.size(); ++k) {
    const double loss = (left[k - 1] - left[k]) * InfiniteSlope::fines_last /
                        (found.at("t")[k] - found.at("t")[k - 1]);
    EXPECT_GE(loss, volume(k - 1) - round_off);
    EXPECT_LE(loss, volume(k) + round_off);
  }
}

TEST(StrengthTable, SnapshotsOfASlopeThatLosesItsFines) {
  const Columns found = infinite_slope().factors("moving", "--state moving.results --time all");
  expect_exact_factors(found);
  expect_exact_fines(found);
}

TEST(StrengthTable, SnapshotsOfARunWithARigidSkeleton) {
  const Columns found = infinite_slope().factors("moving", "--state rigid.results --time all");
  expect_exact_factors(found);
  expect_exact_fines(found);
}

TEST(StrengthTable, SaysBetweenWhichSnapshotsTheFactorFallsBelowOne) {
  const Workshop& w = infinite_slope();
  constexpr double weaker = 4.3;
  ASSERT_GT(InfiniteSlope::exact(4e4, weaker), 1.01);
  ASSERT_LT(InfiniteSlope::exact(6e4, weaker), 0.99);
  w.mesh("weak", InfiniteSlope::scene(true, 1e8, weaker));
  const std::string states = "--state rigid.results --time all";
  const std::string sentence =
      "rigid.results: the factor falls below 1 between t = 40000 and 60000 s\n";
  static_cast<void>(w.table("weak", states));
  EXPECT_NE(w.errors().find(sentence), std::string::npos) << w.errors();
  static_cast<void>(w.table("weak", states + " --quiet"));
  EXPECT_EQ(w.errors().find("falls below"), std::string::npos) << w.errors();
  static_cast<void>(w.table("moving", states));
  EXPECT_EQ(w.errors().find("falls below"), std::string::npos) << w.errors();
}

TEST(StrengthTable, SnapshotsOfSoftSoilThatHasMoved) {
  const Workshop w;
  w.folder().write("infinite.geo", InfiniteSlope::geometry());
  w.mesh("soft", InfiniteSlope::scene(true, 2e6));
  w.solve("soft");
  const Columns found = w.factors("soft", "--state soft.results --time all");
  expect_exact_factors(found);
  expect_fines_of_the_volume(
      found, columns_of(test::read_file(w.folder().file("soft.results/history.csv"))));
}

TEST(StrengthTable, TheStartIsThatOfTheRunAndTheLastSnapshotIsTheDefault) {
  const Workshop& w = infinite_slope();
  const std::string start = w.table("moving");
  EXPECT_EQ(w.table("moving", "--state rigid.results --time 0"), start);  // the same bits
  const Columns moving = w.factors("moving", "--state moving.results --time 0");
  EXPECT_EQ(moving.at("factor"), columns_of(start).at("factor"));
  const std::string last = w.table("moving", "--state moving.results");
  EXPECT_EQ(last, w.table("moving", "--state moving.results --time 80000s"));
  EXPECT_EQ(columns_of(last).at("t")[0], 8e4);
}

TEST(StrengthTable, SameBitsOnTwoThreads) {
  const Workshop& w = infinite_slope();
  const std::string options = "--state moving.results --time 40000";
  EXPECT_EQ(w.table("moving", options), w.table("moving", options + " --threads 2"));
}

// ------------------------------------------------------------------------------------------
// stages

/// Clay that sinks under a footing by an eighth of its depth.
std::string sunk_clay(const std::string& traction, const std::string& start, double end) {
  return "formulation = \"single-point\"\ngravity = [0.0, -9.81]\n"
         "[geometry]\nfile = \"footing.geo\"\n[mesh]\nsize = 0.2\nstructure = \"free\"\n"
         "[liquid]\ndensity = 1000.0\nbulk_modulus = inf\nviscosity = 1e-3\n"
         "[soil.clay]\nporosity = 0.5\nskeleton_fraction = 0.5\ngrain_density = 2650.0\n"
         "conductivity = 1e-3\n[soil.clay.skeleton]\nlaw = \"mohr-coulomb\"\nyoung = 2e5\n"
         "poisson = 0.2\nfriction = 20.0\ncohesion = 20e3\n"
         "[[boundary]]\non = \"top\"\npressure = 0.0\n"
         "[[boundary]]\non = \"foot\"\npressure = 0.0\ntraction = " +
         traction +
         "\n[[boundary]]\non = \"bottom\"\nfix = \"both\"\n"
         "[[boundary]]\non = \"sides\"\nfix = \"normal\"\n[initial]\n" +
         start + "\n[time]\nend = " + number_text(end) +
         "\nfailure = \"stop\"\n[output]\nevery = " + number_text(end) + "\n";
}

/// The next run has other numbers for points that have moved; their soil and strength are the same.
TEST(StrengthTable, ALaterStageHasTheFactorOfTheLastState) {
  const Workshop w;
  w.folder().write("footing.geo",
                   "Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0};\n"
                   "Point(4) = {0.5, 1, 0}; Point(5) = {0, 1, 0};\n"
                   "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};\n"
                   "Line(5) = {5, 1};\nCurve Loop(1) = {1, 2, 3, 4, 5};\nPlane Surface(1) = {1};\n"
                   "Physical Surface(\"clay\") = {1};\nPhysical Curve(\"bottom\") = {1};\n"
                   "Physical Curve(\"sides\") = {2, 5};\nPhysical Curve(\"top\") = {3};\n"
                   "Physical Curve(\"foot\") = {4};\n");
  const std::string load = "[[0.0, 0.0, 0.0], [500.0, 0.0, -4e4]]";
  w.mesh("first", sunk_clay(load, "water_level = 1.0", 1000.0));
  w.solve("first");
  w.mesh("second", sunk_clay("[0.0, -4e4]", "from = \"first.results\"", 1.0));
  w.solve("second");
  const double last = w.factors("first", "--state first.results").at("factor")[0];
  EXPECT_NEAR(w.factors("second").at("factor")[0], last, 1e-9 * last);
  EXPECT_NEAR(w.factors("second", "--state second.results").at("factor")[0], last, 1e-3 * last);
  EXPECT_EQ(w.refusal("second.case.h5 --strength-reduction --state second.results --time 0"),
            "--time: got 0 s of a run that starts from \"first.results\", whose soil has moved; "
            "expected the last state of such a run, at t = 1 s\n");
}

// ------------------------------------------------------------------------------------------
// refusals

TEST(StrengthTable, RefusesStatesAndTimesThatDoNotFit) {
  const Workshop& w = infinite_slope();
  const std::string mode = "moving.case.h5 --strength-reduction ";
  EXPECT_EQ(w.refusal(mode + "--state moving.results --time 3e4"),
            "--time: got 30000, at which moving.results has no snapshot; expected 0, 20000, 40000, "
            "60000 or 80000 s\n");
  EXPECT_EQ(w.refusal(mode + "--state moving.results --time last"),
            "--time: got \"last\"; expected all, or a time in s, or with a unit behind the number, "
            "\"s\", \"min\", \"h\", \"d\" or \"a\", as 2.5d\n");
  EXPECT_EQ(w.refusal(mode + "--state moving.results --time all --mechanism m.hdf"),
            "--mechanism: got a file with --time all; expected one time\n");
  // No state is reduced before.
  EXPECT_EQ(w.refusal(mode + "--state moving.results --time 20000 --mechanism nowhere/m.hdf", 4),
            "nowhere/m.hdf: cannot be created: there is no folder nowhere\n");
  EXPECT_EQ(w.refusal(mode + "--state nowhere", 4), "nowhere: no such results folder\n");
}

TEST(StrengthTable, RefusesAStateOfOtherPointsOrPores) {
  const Workshop& w = infinite_slope();
  std::string scene = InfiniteSlope::scene(true);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = scene;
    return text.replace(text.find(from), from.size(), to);
  };
  w.mesh("fine", changed("size = 0.7", "size = 0.4"));
  EXPECT_EQ(w.refusal("fine.case.h5 --strength-reduction --state moving.results"),
            "--state: got \"moving.results\", whose mesh or solid points differ; expected a run on "
            "those of fine.toml: the keys of [geometry], [mesh] and points.solid_per_element as "
            "there\n");
  w.mesh("loose", changed("porosity = 0.35", "porosity = 0.3"));
  EXPECT_EQ(
      w.refusal("loose.case.h5 --strength-reduction --state moving.results"),
      "--state: got \"moving.results\", whose soil.lower.porosity is another one; expected a run "
      "with that of loose.toml\n");
}

/// The soil of the case has a retention, that of the run has none. The whole suction of the run
/// then held the soil: the factor was 2.9 instead of 1.4. Such a state is refused.
TEST(StrengthTable, RefusesAStateOfAnotherWeightOrSuction) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  Slope slope{.mesh = 4.0, .cohesion = 1.5e4, .water_level = 10.0};
  slope.more = "[[boundary]]\non = \"slope\"\nhead = 10.0\n";
  const std::string scene = slope_scene(slope);
  w.mesh("run", scene);
  w.solve("run");
  const std::vector<std::array<std::string, 3>> changes{
      {"gravity", "-9.81", "-1.62"},
      {"liquid.density", "density = 1000", "density = 1030"},
      {"soil.fill.grain_density", "grain_density = 2700", "grain_density = 2600"},
      {"soil.fill.retention", "alpha = 10.0", "alpha = 1.0"},
      {"soil.fill.retention", R"(retention = {model = "gardner", alpha = 10.0})", ""},
      {"soil.fill.skeleton_fraction", "skeleton_fraction = 0.7", "skeleton_fraction = 0.6"}};
  for (const auto& [key, from, to] : changes) {
    std::string other = scene;
    other.replace(other.find(from), from.size(), to);
    w.mesh("other", other);
    EXPECT_EQ(w.refusal("other.case.h5 --strength-reduction --state run.results"),
              "--state: got \"run.results\", whose " + key +
                  " is another one; expected a run with that of other.toml\n");
  }
}

TEST(StrengthTable, RefusesSoilWithoutStrengthAndSoilThatNothingHolds) {
  const Workshop& w = infinite_slope();
  const std::string none =
      ": --strength-reduction: got no soil with a strength; expected law = \"von-mises\" or "
      "\"mohr-coulomb\" under [soil.NAME.skeleton]\n";
  EXPECT_EQ(w.refusal("rigid.case.h5 --strength-reduction"), "rigid.toml" + none);
  std::string scene = InfiniteSlope::scene(true);
  const std::string support = "[[boundary]]\non = \"bottom\"\nfix = \"both\"\n";
  scene.erase(scene.find(support), support.size());
  w.mesh("loose", scene);
  EXPECT_EQ(w.refusal("loose.case.h5 --strength-reduction", 3),
            "the displacements could not be solved for: nothing holds the soil, or a piece of it; "
            "fix a boundary that it lies on\n");
}

TEST(StrengthTable, RefusesOptionsThatDoNotGoTogether) {
  const Workshop& w = infinite_slope();
  const std::string mode = "moving.case.h5 --strength-reduction ";
  for (const std::string other : {"--resume", "--explain", "--force", "--no-skip"}) {
    EXPECT_EQ(w.refusal(mode + other), other + " excludes --strength-reduction (see --help)\n");
  }
  EXPECT_EQ(w.run("suffuse-solver " + mode + "--element-test a.csv"), 2);
  EXPECT_EQ(w.refusal("moving.case.h5 --state moving.results"),
            "--state requires --strength-reduction (see --help)\n");
  EXPECT_EQ(w.refusal(mode + "--time 0"), "--time requires --state (see --help)\n");
  EXPECT_EQ(w.refusal("moving.case.h5 --mechanism m.hdf"),
            "--mechanism requires --strength-reduction (see --help)\n");
  EXPECT_EQ(w.run("suffuse-solver " + mode + "-o nowhere/a.csv"), 4);
}

TEST(StrengthTable, RefusesSoilThatFailsWithAnyStrengthAndNamesIt) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  std::string scene = slope_scene({.mesh = 4.0, .cohesion = 1.0});
  const std::string friction = "friction = 20.0\ndilation = 20.0\n";
  scene.replace(scene.find(friction), friction.size(), "friction = 0.0\n");
  w.mesh("mud", scene);
  const std::string said = w.refusal("mud.case.h5 --strength-reduction", 3);
  EXPECT_TRUE(
      said.starts_with("at the start: there is no factor of safety: the soil fails, even "
                       "with 64 times its strength; what fails moves most in soil \"fill\" "
                       "at ("))
      << said;
}

/// Air above the soil carries no load: the factor is that of the soil alone.
TEST(StrengthTable, AirAboveTheSoilChangesNothing) {
  const Workshop w;
  std::string geometry = test::read_file(test::source_folder() + "/tests/cases/slope.geo");
  w.folder().write("air.geo", geometry);
  for (const std::string part :
       {"Curve Loop(3)={8,9,10,-5,-4,-3};Plane Surface(3)={3};",
        "Physical Surface(\"free_above\")={3};",
        "Physical Curve(\"sky\")={9};Physical Curve(\"airright\")={8};Physical "
        "Curve(\"airleft\")={10};"}) {
    ASSERT_NE(geometry.find(part), std::string::npos) << part;
    geometry.erase(geometry.find(part), part.size());
  }
  w.folder().write("none.geo", geometry);
  std::vector<double> factors;
  for (const std::string name : {"air", "none"}) {
    w.mesh(name, "geometry.file = \"" + name + ".geo\"\n" + R"(formulation = "single-point"
gravity = [0.0, -9.81]
mesh.size = 0.5
initial.water_level = -10.0
liquid = {density = 1000.0, bulk_modulus = 2e9, viscosity = 1e-3}
time.end = 1.0
output.every = 1.0
[soil.bank]
porosity = 0.3
skeleton_fraction = 0.7
grain_density = 2700.0
conductivity = 1e-5
retention = {model = "gardner", alpha = 10.0}
skeleton = {law = "mohr-coulomb", young = 1e8, poisson = 0.3, friction = 30.0, cohesion = 2e4}
[soil.base]
like = "bank"
[[boundary]]
on = "bottom"
fix = "both"
[[boundary]]
on = "left"
fix = "normal"
[[boundary]]
on = "right"
fix = "normal"
)");
    factors.push_back(w.factors(name).at("factor")[0]);
  }
  EXPECT_GT(factors[0], 2.0);
  EXPECT_NEAR(factors[0], factors[1], 1e-9 * factors[1]);
}

TEST(StrengthTable, WarnsOfSuctionInSoilThatStaysFull) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  std::string scene = slope_scene({.mesh = 4.0, .cohesion = 1e4, .water_level = 5.0});
  const std::string retention = "retention = {model = \"gardner\", alpha = 10.0}\n";
  scene.erase(scene.find(retention), retention.size());
  w.mesh("suction", scene);
  // Water that flows out of a slope of this strength erodes soil at its toe.
  EXPECT_EQ(w.run("suffuse-solver suction.case.h5 --strength-reduction --quiet"), 3);
  EXPECT_TRUE(w.errors().starts_with("suffuse-solver: warning: at the start: suction up to "))
      << w.errors();
}

/// A case with another level than the run has loads of one water and pore pressures of another.
TEST(StrengthTable, WarnsOfALevelThatIsNotThatOfTheRun) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  Slope slope{.mesh = 4.0, .cohesion = 1.5e4, .water_level = 10.0};
  slope.more = "[[boundary]]\non = \"slope\"\nhead = [[0.0, 10.0], [5.0, 8.0]]\n";
  w.mesh("drawn", slope_scene(slope));
  w.solve("drawn");
  slope.more = "[[boundary]]\non = \"slope\"\nhead = 10.0\n";
  w.mesh("full", slope_scene(slope));
  const auto warnings = [&](const std::string& name, const std::string& options) {
    EXPECT_NE(w.table(name, options), "");
    return w.errors();
  };
  EXPECT_EQ(warnings("drawn", "--quiet --state drawn.results"), "");
  EXPECT_EQ(warnings("full", "--quiet --state drawn.results --time 0"), "");
  EXPECT_EQ(warnings("full", "--quiet --state drawn.results"),
            "suffuse-solver: warning: t = 10 s: the water outside of boundary \"slope\" stands at "
            "10 m in the case, and at 8 m in the run that the pore pressures are from: the factor "
            "is of soil with two levels at once\n");
}

/// The level of a reservoir falls in a run with a rigid skeleton. The head of the case loads the
/// soil, and a boundary without one does not.
TEST(StrengthTable, WarnsOfALevelThatIsNotThatOfTheReservoir) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  const std::string scene = slope_scene({.mesh = 4.0, .cohesion = 3e4, .water_level = 10.0});
  const auto with = [&](const std::string& slope, const std::string& back) {
    std::string text = scene + "[[boundary]]\non = \"slope\"\n" + slope;
    const std::string fixed = "on = \"back\"\n";
    return text.insert(text.find(fixed) + fixed.size(), back);
  };
  std::string rigid = with("head = 10.0\nreservoir_area = 2.0\n", "head = 1.0\n");
  const auto erase = [&](const std::string& from, const std::string& to) {
    const std::size_t start = rigid.find(from);
    rigid.erase(start, rigid.find(to, start) - start);
  };
  erase("[soil.fill.skeleton]", "[[boundary]]");
  erase("[[boundary]]", "[[boundary]]\non = \"back\"");
  erase("fix = \"normal\"", "[[boundary]]");
  rigid.replace(rigid.find("1e-5"), 4, "1e-2");
  w.mesh("reservoir", rigid);
  w.solve("reservoir");
  const auto levels = [&](const std::string& slope, const std::string& back) {
    w.mesh("case", with(slope, back));
    EXPECT_NE(w.table("case", "--quiet --state reservoir.results"), "");
    std::string text = w.errors();
    std::string found;
    for (auto at = text.find("boundary \""); at != std::string::npos;
         at = text.find("boundary \"", at + 1)) {
      found += text.substr(at, text.find(" in the run", at) - at) + '\n';
    }
    return found;
  };
  const auto tables = read_tables(w.folder().file("reservoir.results/boundaries.csv"), "boundary");
  const auto slope = std::ranges::find(tables, "slope", &NamedTable::name);
  ASSERT_NE(slope, tables.end());
  const std::string level = shown_number(slope->table.column("level").back());
  EXPECT_LT(std::stod(level), 9.95);
  EXPECT_EQ(levels("head = 10.0\n", "head = 1.0\n"),
            "boundary \"slope\" stands at 10 m in the case, and at " + level + " m\n");
  EXPECT_EQ(levels("head = " + level + "\n", ""),
            "boundary \"back\" stands at no level in the case, and at 1 m\n");
}

/// A law without a strength is elastic in trials: soil that hardens would settle under the loads of
/// a trial in one step, and never hold.
TEST(StrengthTable, ClayBelowStandsAsElasticSoilDoes) {
  const Workshop w;
  std::string geometry = slope_geometry;
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(geometry.find(from), std::string::npos) << from;
    geometry.replace(geometry.find(from), from.size(), to);
  };
  replace("Line(2) = {2, 3};", "Point(5) = {0, 4, 0};\nPoint(6) = {24, 4, 0};\nLine(2) = {2, 6};");
  replace("Line(4) = {4, 1};",
          "Line(4) = {4, 5};\nLine(5) = {6, 3};\nLine(6) = {5, 1};\nLine(7) = {5, 6};");
  replace("Curve Loop(1) = {1, 2, 3, 4};",
          "Curve Loop(1) = {7, 5, 3, 4};\nCurve Loop(2) = {1, 2, -7, 6};\nPlane Surface(2) = "
          "{2};\nPhysical Surface(\"clay\") = {2};");
  replace("\"slope\") = {2}", "\"slope\") = {2, 5}");
  replace("\"back\") = {4}", "\"back\") = {4, 6}");
  w.folder().write("slope.geo", geometry);
  const auto factor = [&](const std::string& law) {
    Slope slope{.mesh = 4.0, .cohesion = 2e4};
    slope.more = "[soil.clay]\nlike = \"fill\"\nskeleton = {law = \"" + law + "}\n";
    w.mesh("layered", slope_scene(slope));
    return w.factors("layered").at("factor").front();
  };
  const double elastic = factor("elastic\", young = 2e7, poisson = 0.3");
  EXPECT_GT(elastic, 1.0);
  EXPECT_LT(elastic, 10.0);
  EXPECT_EQ(factor("cam-clay\", young = 2e7, poisson = 0.3, critical_friction = 25.0, "
                   "compression = 0.1, preconsolidation = 1e5"),
            elastic);
  EXPECT_NE(w.errors().find("soil \"clay\" is elastic in all trials and does not fail: its law, "
                            "cam-clay, has no strength to divide"),
            std::string::npos)
      << w.errors();
}

/// Terzaghi's depth of cracks: 2 * 25 kPa / 17 kN/m3 in the half of a cut that is 5 m high.
TEST(StrengthTable, WarnsOfTensionThatCohesionBears) {
  const Workshop w;
  w.folder().write("slope.geo", slope_geometry);
  const auto warns = [&](double cohesion) {
    w.mesh("slope", slope_scene({.mesh = 4.0, .cohesion = cohesion}));
    EXPECT_NE(w.table("slope", "--quiet"), "");
    return w.errors();
  };
  EXPECT_EQ(warns(1e4), "");
  const std::string text = warns(4e4);
  EXPECT_TRUE(
      text.starts_with("suffuse-solver: warning: soil \"fill\" bears tension: its cohesion "
                       "holds up to "))
      << text;
  EXPECT_TRUE(
      text.ends_with(" m below the ground, of 10 m of soil, where cracks may open; the "
                     "factor takes none into account\n"))
      << text;
}

TEST(StrengthTable, WarnsOfAWallThatNoSlipSurfaceCrosses) {
  const Workshop w;
  w.folder().write("slope.geo", std::string(slope_geometry) + R"(
Point(5) = {6, 2, 0};
Point(6) = {6, 8, 0};
Line(5) = {5, 6};
Curve{5} In Surface{1};
Physical Curve("core") = {5};
)");
  Slope slope{.mesh = 4.0, .cohesion = 1e4};
  slope.more = "[[wall]]\non = \"core\"\n";
  w.mesh("walled", slope_scene(slope));
  EXPECT_NE(w.table("walled", "--quiet"), "");
  EXPECT_EQ(w.errors(),
            "suffuse-solver: warning: the wall \"core\" stands still in all trials: soil slides "
            "along it, and no slip surface crosses it\n");
}

}  // namespace strength_table_test
}  // namespace suffuse
