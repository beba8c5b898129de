/// Results of the solver do not depend on the numbers of elements and nodes, except for round-off.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "geometry.hpp"
#include "mesher/shuffled_mesh.hpp"
#include "seeding.hpp"
#include "temporary_folder.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace numbering_test {

using test::TemporaryFolder;

/// Soil of uneven porosity that erodes by the flux, and whose conductivity follows.
const std::string scene_of_soil = test::scene_text(
    "[geometry]\nshape = \"column\"\nwidth = 1.0\nheight = 1.0\n"
    "[mesh]\nsize = 0.08\nstructure = \"free\"\n",
    "porosity_gradient = [0.04, 0.05]\nconductivity_law = \"kozeny-carman\"\n"
    "[soil.specimen.erosion]\nlaw = \"flux\"\nrate = 2.0\n"
    "[[boundary]]\non = \"top\"\npressure = 6000.0\nconcentration = 0.0\n"
    "[[boundary]]\non = \"bottom\"\npressure = 0.0\n"
    "[initial]\nflow = \"steady\"\n");

/// A table of the results, by rows.
std::vector<std::vector<double>> read_table(const std::string& path) {
  std::istringstream lines(test::read_file(path));
  std::string line;
  std::getline(lines, line);  // names of the columns
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream values(line);
    rows.emplace_back();
    for (double value = 0.0; values >> value;) rows.back().push_back(value);
  }
  return rows;
}

/// Runs the solver on the scene with this mesh. Returns the folder of the results.
std::string solve(const TemporaryFolder& folder, const std::string& name, Mesh<2> mesh,
                  const SceneDocument& document) {
  Case<2> made{document, std::move(mesh), {}, {}};
  made.solid_points = seed_solid_points(made.mesh, document.scene);
  write_case(folder.file(name + ".case.h5"), made);
  const std::string command = "cd '" + folder.path().string() + "' && '" + test::program_folder() +
                              "/suffuse-solver' --quiet " + name + ".case.h5";
  EXPECT_EQ(std::system(command.c_str()), 0) << name;
  return folder.file(name + ".results");
}

class Numbering : public testing::TestWithParam<std::string> {};

TEST_P(Numbering, ChangesResultsByRoundOffAlone) {
  const TemporaryFolder folder;
  const SceneDocument document =
      parse_scene(scene_of_soil, "scene.toml", {"time=" + GetParam(), "output.every=0.5"});
  const Mesh<2> mesh = build_geometry_of<2>(document).mesh;
  const std::string along_curve = solve(folder, "along_curve", mesh, document);
  const std::string at_random = solve(folder, "at_random", test::shuffled(mesh), document);
  for (const std::string table : {"/history.csv", "/ledger.csv"}) {
    const auto rows = read_table(along_curve + table);
    const auto others = read_table(at_random + table);
    ASSERT_EQ(rows.size(), 5U) << table;
    ASSERT_EQ(others.size(), rows.size()) << table;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(others[i].size(), rows[i].size()) << table;
      for (std::size_t column = 0; column < rows[i].size(); ++column) {
        const double value = rows[i][column];
        EXPECT_NEAR(others[i][column], value, 1e-10 * std::max(1.0, std::abs(value)))
            << table << ", row " << i << ", column " << column;
      }
    }
  }
  const auto ledger = read_table(along_curve + "/ledger.csv");
  EXPECT_LT(ledger.back()[2], ledger.front()[2] - 0.1) << "nothing has eroded";
}

INSTANTIATE_TEST_SUITE_P(Schemes, Numbering,
                         testing::Values("{end=2.0,scheme=\"explicit\",mass_scaling=1e4}",
                                         "{end=2.0,scheme=\"implicit\",step=0.25}"));

}  // namespace numbering_test
}  // namespace suffuse
