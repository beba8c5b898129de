#include "tools/element_test.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>

#include "common/errors.hpp"
#include "mesher/temporary_folder.hpp"
#include "solver/csv_columns.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace element_test_test {

using test::columns_of;
using test::TemporaryFolder;

constexpr const char* scene = R"(formulation = "single-point"
geometry = { shape = "column", width = 1, height = 2 }
mesh.size = 0.25
liquid = { density = 1000, bulk_modulus = 2e9, viscosity = 1e-3 }
time.end = 100
output.every = 10
[soil.sand]
porosity = 0.3
skeleton_fraction = 0.6
grain_density = 2700
conductivity = 1e-5
[soil.sand.skeleton]
law = "mohr-coulomb"
young = [[1, 2e7], [0, 1.8e7]]
poisson = 0.3
friction = [[1, 34], [0, 28]]
cohesion = 0
[soil.clay]
like = "sand"
skeleton = { law = "von-mises", young = 1e6, poisson = 0.4, cohesion = 2e4 }
[soil.rock]
porosity = 0.1
skeleton_fraction = 0.9
grain_density = 2700
conductivity = 1e-9
)";

constexpr const char* triaxial = R"(step,stress_xx,stress_yy,stress_zz,strain_yy,fines_left
0,-1e5,-1e5,-1e5,,1
1,-1e5,,-1e5,-0.02,1
2,-1e5,,-1e5,-0.02,0
)";

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The output of an element test, or its messages without the name of the file.
std::string answer(const std::string& table, const std::string& soil = "sand", int steps = 1) {
  const TemporaryFolder folder;
  const std::string path = folder.write("table.csv", table);
  try {
    const SceneDocument document = parse_scene(scene, "scene.toml");
    return element_test(*document.scene.find_soil(soil), read_element_table(path), steps);
  } catch (const InputError& error) {
    std::string text = error.what();
    for (std::size_t at = 0; (at = text.find(path)) != std::string::npos;) {
      text.erase(at, path.size() + 1);
    }
    return text;
  }
}

/// The path of Cam clay is followed in increments, however few rows are asked for. Towards the
/// critical state q = M p', with M = 6 sin(phi) / (3 - sin(phi)).
TEST(ElementTest, follows_the_path_of_soil_that_hardens) {
  std::string mud = scene;
  const std::string law = "law = \"mohr-coulomb\"";
  mud.replace(mud.find(law), law.size(),
              "law = \"cam-clay\"\ncompression = 0.1\npreconsolidation = 2e5\n"
              "critical_friction = 25");
  for (const std::string key : {"friction = [[1, 34], [0, 28]]\n", "cohesion = 0\n"}) {
    mud.erase(mud.find("\n" + key) + 1, key.size());
  }
  const TemporaryFolder folder;
  const std::string path = folder.write("table.csv",
                                        "step,stress_xx,stress_yy,stress_zz,strain_yy\n"
                                        "0,-2e5,-2e5,-2e5,\n1,-2e5,,-2e5,-0.6\n");
  const SceneDocument document = parse_scene(mud, "scene.toml");
  const auto strength = [&](int steps) {
    const std::string text =
        element_test(*document.scene.find_soil("sand"), read_element_table(path), steps);
    return columns_of(text)["deviator_stress"].back();
  };
  const double exact = strength(4000);
  EXPECT_NEAR(strength(1), exact, 1e-3 * exact);
  EXPECT_NEAR(strength(7), exact, 1e-3 * exact);
  const double s = std::sin(25.0 * std::numbers::pi / 180.0);
  const double ratio = 6.0 * s / (3.0 - s);
  const double critical = ratio * 2e5 / (1.0 - ratio / 3.0);
  EXPECT_LT(exact, critical);
  EXPECT_GT(exact, 0.98 * critical);
}

TEST(ElementTest, answers_a_triaxial_table) {
  auto columns = columns_of(answer(triaxial));
  ASSERT_EQ(columns.size(), 14U);
  ASSERT_EQ(columns["step"], (std::vector{0.0, 1.0, 2.0}));
  EXPECT_EQ(columns["mean_stress"][0], 1e5);
  EXPECT_EQ(columns["deviator_stress"][0], 0.0);
  EXPECT_EQ(columns["strain_yy"], (std::vector{0.0, -0.02, -0.02}));
  EXPECT_EQ(columns["fines_left"], (std::vector{1.0, 1.0, 0.0}));
  for (const auto& [row, friction] : {std::pair{1, 34.0}, std::pair{2, 28.0}}) {
    const double s = std::sin(friction * std::numbers::pi / 180.0);
    EXPECT_NEAR(columns["deviator_stress"][row], 2e5 * s / (1.0 - s), 1e-5);
    EXPECT_NEAR(columns["mean_stress"][row], 1e5 + columns["deviator_stress"][row] / 3.0, 1e-5);
    EXPECT_NEAR(columns["stress_xx"][row], -1e5, 1e-5);
    EXPECT_NEAR(columns["volumetric_strain"][row],
                columns["strain_yy"][row] + 2.0 * columns["strain_xx"][row], 1e-12);
  }
  EXPECT_GT(columns["plastic_strain"][1], 0.0);
  EXPECT_GT(columns["plastic_strain"][2], columns["plastic_strain"][1]);
}

TEST(ElementTest, steps_lie_between_the_rows_of_the_table) {
  auto columns = columns_of(answer(triaxial, "sand", 4));
  ASSERT_EQ(columns["step"].size(), 9U);
  EXPECT_EQ(columns["step"][3], 0.75);
  EXPECT_NEAR(columns["strain_yy"][3], -0.015, 1e-15);
  EXPECT_NEAR(columns["fines_left"][6], 0.5, 1e-15);
}

TEST(ElementTest, other_laws_and_columns) {
  // The undrained strength in plane strain, half the difference of the stresses, is the cohesion.
  auto columns = columns_of(
      answer("t,strain_xx,strain_yy,strain_zz,strain_xy\n0,,,,\n10,0.2,-0.2,0,0\n", "clay"));
  EXPECT_EQ(columns["t"], (std::vector{0.0, 10.0}));
  EXPECT_NEAR(columns["deviator_stress"][1], std::sqrt(3.0) * 2e4, 1e-6);
  EXPECT_NEAR(columns["stress_xx"][1] - columns["stress_yy"][1], 4e4, 1e-6);
  EXPECT_EQ(columns["volumetric_strain"][1], 0.0);
}

TEST(ElementTest, names_the_row_whose_stress_the_soil_cannot_carry) {
  EXPECT_EQ(answer("stress_xx,stress_yy,stress_zz\n-1e5,-1e5,-1e5\n-1e5,-3e5,-1e5\n"
                   "-1e5,-4e5,-1e5\n"),
            "4: got stresses that the soil cannot carry: it yields on the way to this row at xx "
            "-1e+05, yy -3.537e+05, zz -1e+05, xy 0 Pa with 1 of its fines left; expected stresses "
            "within the strength, or a strain in the place of one of them");
  EXPECT_EQ(answer("stress_xx,stress_yy,stress_zz\n-1e5,-4e5,-1e5\n"),
            "2: got a stress at the start beyond the strength: xx -1e+05, yy -4e+05, zz -1e+05, xy "
            "0 Pa; expected one that the soil can carry");
}

TEST(ElementTest, says_what_is_wrong_in_a_table) {
  const std::array<std::pair<const char*, const char*>, 6> cases{{
      {"", "1: got no row; expected a header line and at least one row, the start"},
      {"stress_xx,stress_yy\n",
       "1: strain_zz: got no column; expected strain_zz or stress_zz, or both"},
      {"stress_xx,stres_yy,stress_zz\n",
       "1: got \"stres_yy\"; expected columns t, step, strain_xx, strain_yy, strain_zz, strain_xy, "
       "stress_xx, stress_yy, stress_zz, stress_xy and fines_left; did you mean stress_yy?"},
      {"stress_xx;stress_yy;stress_zz\n0;0;0\n",
       "1: got \"stress_xx;stress_yy;stress_zz\"; expected columns t, step, strain_xx, strain_yy, "
       "strain_zz, strain_xy, stress_xx, stress_yy, stress_zz, stress_xy and fines_left, with "
       "commas between columns in the place of semicolons, and decimal points in numbers"},
      {"t,step,stress_xx,stress_yy,stress_zz\n",
       "1: step: got a column in addition to t; expected one of the two"},
      {"t,t,stress_xx,stress_yy,stress_zz\n",
       "1: t: got a column twice; expected one column of a name"},
  }};
  for (const auto& [table, message] : cases) EXPECT_EQ(answer(table), message);
  EXPECT_EQ(answer("step,stress_xx,stress_yy,stress_zz,strain_yy,fines_left\n"
                   "0,-1e5,-1e5,-1e5,-1,1\n"
                   "0,-1e5,,-1e5,,1\n"
                   "1,-1e5,-1,-1e5,-0.1,2\n"
                   "2,x,-1,-1e5,-10,\n"
                   "3,x\n"),
            "2: strain_yy: got -1; expected 0 or nothing in the first row, which is the start\n"
            "3: strain_yy: got nothing; expected a value, of a strain or a stress\n"
            "3: step: got 0; expected more than 0, of the row before\n"
            "4: fines_left: got 2; expected a share of the erodible fines, 0 to 1\n"
            "5: stress_xx: got \"x\"; expected a number\n"
            "5: strain_yy: got -10; expected a logarithmic strain between -2 and 2: -0.1 is a "
            "tenth, in compression\n"
            "5: fines_left: got nothing; expected a number\n"
            "6: got 2 values; expected 6, as many as columns");
  EXPECT_EQ(answer("stress_xx,stress_yy,stress_zz,strain_yy\n0,0,0,\n0,-1,0,-0.1\n"),
            "3: stress_yy: got a value in addition to that of strain_yy; expected one of the two");
}

/// The program, and its output.
struct Program {
  TemporaryFolder folder;
  std::string path = folder.write("scene.toml", scene);
  std::string table = folder.write("table.csv", triaxial);

  int run(const std::string& arguments) const {
    const std::string command = test::program_folder() + "/suffuse-solver " + arguments + " > " +
                                folder.file("out") + " 2> " + folder.file("errors");
    return WEXITSTATUS(std::system(command.c_str()));
  }
  [[nodiscard]] std::string errors() const { return text_of(folder.file("errors")); }
};

TEST(ElementTest, program_writes_a_file_or_shows_the_table) {
  const Program program;
  const std::string test = program.path + " --soil sand --element-test " + program.table;
  ASSERT_EQ(program.run(test), 0) << program.errors();
  EXPECT_EQ(text_of(program.folder.file("out")), answer(triaxial));
  ASSERT_EQ(program.run(test + " -o " + program.folder.file("a.csv") +
                        " --steps 5 --set soil.sand.skeleton.cohesion=1e3"),
            0);
  EXPECT_EQ(columns_of(text_of(program.folder.file("a.csv")))["step"].size(), 11U);
}

TEST(ElementTest, program_refuses_and_writes_nothing) {
  const Program program;
  const std::string test =
      program.path + " --element-test " + program.table + " -o " + program.folder.file("a.csv");
  EXPECT_EQ(program.run(test), 2);
  EXPECT_EQ(program.errors(), "suffuse-solver: error: " + program.path +
                                  ": got 2 soils with a law of the skeleton; expected "
                                  "--soil with \"sand\" or \"clay\"\n");
  EXPECT_EQ(program.run(test + " --soil sandy"), 2);
  EXPECT_EQ(program.errors(), program.path +
                                  ": --soil: got \"sandy\"; expected \"sand\" or "
                                  "\"clay\"; did you mean \"sand\"?\n");
  EXPECT_EQ(program.run(test + " --soil rock"), 2);
  EXPECT_EQ(program.errors(), program.path +
                                  ": --soil: got \"rock\", whose skeleton is rigid; "
                                  "expected \"sand\" or \"clay\"\n");
  EXPECT_EQ(program.run(program.folder.file("a.case.h5") + " --element-test t.csv"), 2);
  EXPECT_EQ(program.run(program.path + " --soil sand"), 2);
  EXPECT_EQ(program.run(test + " --resume"), 2);
  EXPECT_EQ(program.run(program.path + " --soil sand --element-test nowhere.csv"), 4);
  EXPECT_EQ(program.errors(), "suffuse-solver: error: nowhere.csv: cannot be read\n");
  EXPECT_FALSE(std::filesystem::exists(program.folder.file("a.csv")));
}

}  // namespace element_test_test
}  // namespace suffuse
