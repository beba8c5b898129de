#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "case/case_file.hpp"
#include "case/mesh_sizes.hpp"
#include "temporary_folder.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace command_line_test {

using test::TemporaryFolder;

struct Outcome {
  int code;
  std::string text;  // stdout and stderr
};

class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    folder_.write("column.toml", test::scene_text(test::unit_column,
                                                  "[[boundary]]\non = \"top\"\npressure = 1.0\n"));
  }

  /// Runs suffuse-mesher in the folder, after the shell commands `before`.
  [[nodiscard]] Outcome run(const std::string& arguments, const std::string& before = ":") const {
    const std::string command = "cd '" + folder_.path().string() + "' && " + before + " && '" +
                                test::program_folder() + "/suffuse-mesher' " + arguments + " 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::string text;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      text.append(buffer.data(), n);
    }
    const int status = ::pclose(pipe);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
  }

  TemporaryFolder folder_;
};

TEST_F(CommandLine, MakesACaseNamedAfterTheScene) {
  const Outcome outcome = run("column.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(outcome.text.substr(0, outcome.text.find('\n')), "column.case.h5");
  EXPECT_NE(outcome.text.find("  elements         32\n"), std::string::npos) << outcome.text;
  EXPECT_EQ(folder_.count(), 2);
  const Case<2> made = read_case<2>(folder_.file("column.case.h5"));
  EXPECT_EQ(made.mesh.element_count(), 32);
  EXPECT_EQ(made.solid_points.size(), 96);
  EXPECT_EQ(made.document.path, "column.toml");
}

TEST_F(CommandLine, SaysWhereTheCaseOfASceneInAnotherFolderIs) {
  const std::string before = "mkdir -p other/here && cp column.toml other";
  const Outcome outcome = run("other/column.toml", before);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  const std::string place = std::filesystem::canonical(folder_.path()) / "column.case.h5";
  EXPECT_NE(outcome.text.find("  note: the case is in the current folder, " + place +
                              "; -o other/column.case.h5 puts it beside the scene\n"),
            std::string::npos)
      << outcome.text;
  EXPECT_TRUE(std::filesystem::exists(folder_.file("column.case.h5")));
  for (const std::string arguments : {"column.toml", "./column.toml", "other/../column.toml",
                                      "other/column.toml -o other/column.case.h5"}) {
    EXPECT_EQ(run(arguments).text.find("note: the case"), std::string::npos) << arguments;
  }
}

TEST_F(CommandLine, MakesADoublePointCase) {
  const Outcome outcome =
      run("'" + test::data_folder() + "/scenes/double-point.toml' -o dp.case.h5 --msh dp.msh");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(outcome.text,
            "dp.case.h5\n"
            "  elements          96\n"
            "  nodes             65\n"
            "  solid points      64\n"
            "  liquid points     2048 (12 to 40 per element)\n"
            "  median edge       0.25 m; mesh.size is 0.25 m\n"
            "  smallest angle    45 degrees\n"
            "  region outflow    0.5 m2, free water\n"
            "  region buffer     1 m2\n"
            "  region specimen   1 m2\n"
            "  region inflow     0.5 m2, free water\n"
            "  boundary inflow   1 m\n"
            "  boundary outflow  1 m\n"
            "  boundary left     3 m\n"
            "  boundary right    3 m\n");
  const Case<2> made = read_case<2>(folder_.file("dp.case.h5"));
  EXPECT_EQ(made.mesh.element_count(), 96);
  EXPECT_EQ(made.solid_points.size(), 64);
  EXPECT_EQ(made.liquid_points.size(), 64 * 12 + 32 * 40);
}

constexpr const char* gap_graded = "soil.specimen.gradation=[[0.1,0],[0.6,15],[2.4,17.1],[10,100]]";

constexpr const char* gap_graded_summary =
    "  grading of specimen\n"
    "    fines: F* = 15 % finer than 0.6 mm, where H/F = 0.14 is smallest\n"
    "    skeleton: n_C = 0.6 as given, fines of 14.3 %\n"
    "    Kezdi (1979)           unstable  largest D'15/d'85 is 18.7, split at 2.47 %; above 4 is "
    "unstable\n"
    "    Kenney and Lau (1986)  unstable  smallest H/F up to F = 30 % is 0.14, at 15 %; below 1 is "
    "unstable\n"
    "    Li and Fannin (2008)   unstable  smallest H/min(F, 15 %) up to F = 35 % is 0.14, at 15 %; "
    "below 1 is unstable\n"
    "    Burenkova (1993)       unstable  d90/d60 = 1.68, d90/d15 = 14; between 1.87 and 3.13 is "
    "stable\n"
    "    Wan and Fell (2008)    unstable  probability of being unstable 57.8 %\n";

TEST_F(CommandLine, ChecksGradationsAndWritesNothing) {
  const Outcome outcome = run("--check column.toml --set '" + std::string(gap_graded) + "'");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.text, "column.toml\n" + std::string(gap_graded_summary));
  const Outcome without = run("column.toml --check");
  EXPECT_EQ(without.code, 0);
  EXPECT_EQ(without.text, "column.toml: no soil has a gradation, nothing to check\n");
  EXPECT_EQ(folder_.count(), 1);
}

TEST_F(CommandLine, ChecksGradationsOfASceneWithoutItsGeometry) {
  folder_.write("dam.toml", test::scene_text("geometry.file = \"dam.geo\"\n"));
  EXPECT_EQ(run("dam.toml --check").text, "dam.toml: no soil has a gradation, nothing to check\n");
  EXPECT_EQ(run("dam.toml").code, 4);
}

TEST_F(CommandLine, SaysWhereTheSkeletonComesFrom) {
  std::string scene = test::read_file(folder_.file("column.toml"));
  const std::string line = "skeleton_fraction = 0.6\n";
  scene.replace(scene.find(line), line.size(), "gradation = [[0.1,0],[0.5,15],[4,15],[8,100]]\n");
  folder_.write("graded.toml", scene);
  const Outcome outcome = run("graded.toml");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.text.find("  boundary right   1 m\n"
                              "  grading of specimen\n"
                              "    fines: F* = 15 % finer than 0.5 mm, where H/F = 0 is smallest\n"
                              "    skeleton: n_C = 0.595 = (1 - n_0)(1 - F*), as skeleton_fraction "
                              "is not given\n"),
            std::string::npos)
      << outcome.text;
  const Case<2> made = read_case<2>(folder_.file("graded.case.h5"));
  EXPECT_DOUBLE_EQ(made.document.scene.soils[0].skeleton_fraction, 0.7 * 0.85);
}

TEST_F(CommandLine, WarnsOfErosionThatTheGradationContradicts) {
  const std::string erosion =
      " --set soil.specimen.erosion.law=constant --set soil.specimen.erosion.rate=1e-3";
  const auto warnings = [&](const std::string& gradation, const std::string& more) {
    const std::string key = "--set 'soil.specimen.gradation=" + gradation + "' ";
    const Outcome outcome = run("--check column.toml " + key + more);
    EXPECT_EQ(outcome.code, 0);
    const std::size_t begin = outcome.text.find("suffuse-mesher: ");
    return begin == std::string::npos ? "" : outcome.text.substr(begin);
  };
  const std::string dense = "[[0.1,0],[1,50],[4,100]]";
  EXPECT_EQ(warnings(dense, erosion),
            "suffuse-mesher: warning: --set soil.specimen.gradation=" + dense +
                ": soil.specimen.gradation: is stable by Li and Fannin (2008), but erosion.law = "
                "\"constant\" erodes it: fines of such a soil hardly move between its grains\n");
  const std::string floating = "[[0.01,0],[0.2,40],[1,40],[10,100]]";
  EXPECT_EQ(warnings(floating, erosion),
            "suffuse-mesher: warning: --set soil.specimen.gradation=" + floating +
                ": soil.specimen.gradation: has 40 % of fines, above 35 %, but erosion.law = "
                "\"constant\" erodes them: they carry load, and a skeleton without them would "
                "settle, which a rigid one does not\n");
  EXPECT_EQ(warnings("[[0.1,0],[0.6,15],[2.4,17.1],[10,100]]", erosion), "");
  for (const std::string& gradation : {dense, floating}) EXPECT_EQ(warnings(gradation, ""), "");
}

TEST_F(CommandLine, WarnsWhenItMakesACaseToo) {
  const Outcome outcome =
      run("column.toml --set 'soil.specimen.gradation=[[0.1,0],[1,50],[4,100]]' --set "
          "soil.specimen.erosion.law=constant --set soil.specimen.erosion.rate=1e-3");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(folder_.count(), 2);
  EXPECT_NE(outcome.text.find("suffuse-mesher: warning: --set soil.specimen.gradation="),
            std::string::npos)
      << outcome.text;
}

TEST_F(CommandLine, RefusesMoreLiquidPointsThanAnyoneMeans) {
  // Elements of free water hold 1e9 times as much liquid as those of this soil.
  const Outcome outcome = run("'" + test::data_folder() +
                              "/scenes/double-point.toml' --set soil.specimen.porosity=1e-8");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.text.find("double-point.toml:21: points.liquid_per_element: got "
                              "32000000768 liquid points in all; expected at most 100 million: "
                              "fewer per element, or larger elements"),
            std::string::npos)
      << outcome.text;
  EXPECT_EQ(folder_.count(), 1);
}

TEST_F(CommandLine, OverridesAndOutputs) {
  const Outcome outcome =
      run("--set points.solid_per_element=12 --set mesh.size=0.5 column.toml -o other.case.h5 "
          "--msh mesh.msh");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(folder_.count(), 4);  // scene, case, mesh and its colours
  const Case<2> made = read_case<2>(folder_.file("other.case.h5"));
  EXPECT_EQ(made.solid_points.size(), 12 * 8);
  EXPECT_EQ(made.document.overrides,
            (std::vector<std::string>{"points.solid_per_element=12", "mesh.size=0.5"}));
}

TEST_F(CommandLine, MeshesWithTheSizesOfAFile) {
  ASSERT_EQ(run("column.toml").code, 0);
  const Mesh<2> old = read_case<2>(folder_.file("column.case.h5")).mesh;
  write_mesh_sizes(folder_.file("column.sizes.h5"), old,
                   std::vector<double>(old.nodes.size(), 0.05));
  const Outcome outcome = run("column.toml --sizes column.sizes.h5 -o fine.h5");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(outcome.text.find("mesh.size"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("  note: sizes of elements are those of column.sizes.h5\n"),
            std::string::npos)
      << outcome.text;
  const Mesh<2> fine = read_case<2>(folder_.file("fine.h5")).mesh;
  EXPECT_NEAR(fine.element_count(), 4.0 / std::sqrt(3.0) / (0.05 * 0.05), 100.0);
  ASSERT_EQ(run("column.toml --sizes column.sizes.h5 -o again.h5").code, 0);
  EXPECT_EQ(test::read_file(folder_.file("fine.h5")), test::read_file(folder_.file("again.h5")));
}

TEST_F(CommandLine, SaysTheSizeThatTheSceneDoesNotGive) {
  std::string scene = test::read_file(folder_.file("column.toml"));
  const std::string line = "size = 0.25\n";
  scene.replace(scene.find(line), line.size(), "");
  folder_.write("column.toml", scene);
  const Outcome outcome = run("column.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("  elements         20000\n"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("  note: mesh.size was not given: 0.01 m, for about 20 000 elements"),
            std::string::npos)
      << outcome.text;
}

TEST_F(CommandLine, EqualScenesGiveEqualFiles) {
  ASSERT_EQ(run("column.toml -o a.h5").code, 0);
  ASSERT_EQ(run("column.toml -o b.h5").code, 0);
  EXPECT_EQ(test::read_file(folder_.file("a.h5")), test::read_file(folder_.file("b.h5")));
}

TEST_F(CommandLine, WarnsOfWhatIsUnusual) {
  const Outcome outcome = run(
      "column.toml --set liquid.density=1.0 --set initial.water_level=0 --set gravity=[0,-9.81]");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(
      outcome.text.find("suffuse-mesher: warning: --set liquid.density=1.0: liquid.density: 1 "
                        "kg/m3; 500 to 2000 are usual, water has 1000\n"),
      std::string::npos)
      << outcome.text;
  EXPECT_NE(outcome.text.find("warning: column.toml:19: soil.specimen.retention: none, and a "
                              "suction of 1 m of water at (0, 1)"),
            std::string::npos)
      << outcome.text;
  EXPECT_EQ(run("column.toml").text.find("warning"), std::string::npos);
}

TEST_F(CommandLine, AnEndlessGeometryIsStopped) {
  folder_.write("endless.toml", test::scene_text("[geometry]\nfile = \"" + test::data_folder() +
                                                 "/geometry/endless.geo\"\n"));
  const Outcome outcome = run("endless.toml --geometry-timeout 0.5");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(
      outcome.text,
      "endless.toml:4: geometry.file: got \"" + test::data_folder() +
          "/geometry/endless.geo\", over which Gmsh has spent 0.5 s of processor time without an "
          "end; expected a file without endless loops and with sizes that suit the model; for a "
          "large one a longer --geometry-timeout\n");
  EXPECT_EQ(folder_.count(), 2);
}

TEST_F(CommandLine, TheTimeLimitEndsWithTheGeometry) {
  folder_.write("square.toml", test::scene_text("[geometry]\nfile = \"" + test::data_folder() +
                                                "/geometry/square.geo\"\n[mesh]\nsize = 0.1\n"));
  const Outcome outcome = run("square.toml --geometry-timeout 30");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

TEST_F(CommandLine, HelpStatesTheExitCodes) {
  const std::string help = run("--help").text;
  EXPECT_NE(
      help.find("Exit codes:\n  0    done\n  2    the scene, the geometry or the command line "
                "is wrong\n  3    out of memory, or a bug\n  4    a file cannot be read or "
                "written\n  130  interrupted by Ctrl-C\n"),
      std::string::npos)
      << help;
}

TEST_F(CommandLine, PrintsVersionReferenceAndHelp) {
  EXPECT_EQ(run("--version").text.substr(0, 15), "suffuse-mesher ");
  EXPECT_EQ(run("--version").code, 0);
  EXPECT_EQ(run("--scene-reference").text, scene_reference_markdown());
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_EQ(folder_.count(), 1);
}

struct Wrong {
  std::string arguments;
  int code;
  std::string text;
};

void PrintTo(const Wrong& wrong, std::ostream* stream) {
  *stream << wrong.arguments;
}

class WrongCommandLine : public CommandLine, public testing::WithParamInterface<Wrong> {};

TEST_P(WrongCommandLine, IsRefusedAndWritesNothing) {
  const std::string scene = test::read_file(folder_.file("column.toml"));
  const Outcome outcome = run(GetParam().arguments);
  EXPECT_EQ(outcome.code, GetParam().code) << outcome.text;
  EXPECT_NE(outcome.text.find(GetParam().text), std::string::npos) << outcome.text;
  EXPECT_EQ(folder_.count(), 1);
  EXPECT_EQ(test::read_file(folder_.file("column.toml")), scene);
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongCommandLine,
    testing::Values(
        Wrong{"", 2, "a scene file is missing; expected suffuse-mesher SCENE.toml"},
        Wrong{"column.toml --ms a.msh", 2,
              "got \"--ms\"; expected an option of suffuse-mesher (see --help); did you mean "
              "--msh?"},
        Wrong{"column.toml second.toml", 2, "got \"second.toml\"; expected one scene file only"},
        Wrong{"column.toml -o", 2, "(see --help)"},
        Wrong{"column.toml -o column.toml", 2, "-o column.toml would overwrite an input"},
        Wrong{"column.toml --msh a.vtk", 2, "--msh: got a.vtk; expected a name that ends in .msh"},
        Wrong{"column.toml --check -o a.h5", 2,
              "--check with -o: it writes no file; expected one of the two"},
        Wrong{"column.toml --check --msh a.msh", 2,
              "--check with --msh: it writes no file; expected one of the two"},
        Wrong{"column.toml --check --sizes a.h5", 2,
              "--check with --sizes: it makes no mesh; expected one of the two"},
        Wrong{"column.toml --size a.h5", 2, "did you mean --sizes?"},
        Wrong{"column.toml --sizes ''", 2, "--sizes: got an empty name; expected that of a file"},
        Wrong{"column.toml --sizes a.h5", 4, "a.h5: there is no such file"},
        Wrong{"column.toml --sizes column.toml", 4, "column.toml: is not an HDF5 file"},
        Wrong{"column.toml --sizes a.h5 -o ./a.h5", 2, "-o ./a.h5 would overwrite an input"},
        Wrong{"--check", 2, "a scene file is missing; expected suffuse-mesher SCENE.toml"},
        Wrong{"column.toml --geometry-timeout 0", 2, "--geometry-timeout: Value 0 not in range"},
        Wrong{"column.toml --geometry-timeout nan", 2, "--geometry-timeout: Value nan is not"},
        Wrong{"column.toml --geometry-timout 9", 2, "did you mean --geometry-timeout?"},
        Wrong{"column.toml --chek", 2, "did you mean --check?"},
        Wrong{"column.toml --check --set soil.specimen.gradation=[[1,100]]", 2,
              "soil.specimen.gradation: got 1 point; expected at least 3 pairs"},
        Wrong{"column.toml -o a.msh --msh ./a.msh", 2, "-o and --msh name the same file ./a.msh"},
        Wrong{"column.toml --set mesh.sise=1", 2, "--set mesh.sise=1"},
        Wrong{"column.toml --set 'boundary[0].on=\"tip\"'", 2, "did you mean \"top\"?"},
        Wrong{"nowhere.toml", 4, "nowhere.toml"}, Wrong{"''", 2, "a scene file is missing"},
        Wrong{".", 4, "cannot read the scene ."},
        Wrong{"/dev/full", 4, "/dev/full: is larger than 100 MB; is it a scene?"},
        Wrong{"/proc/self/mem", 4, "cannot read the scene /proc/self/mem"},
        Wrong{"/dev/null", 2, "/dev/null: formulation: got nothing"},
        Wrong{std::string(5000, 'a'), 4, "cannot read the scene aaa"},
        Wrong{"column.toml -o " + std::string(5000, 'a'), 4, ": File name too long"},
        Wrong{"column.toml -o ''", 2, "--output: got an empty name; expected that of a file"},
        Wrong{"column.toml --msh ''", 2, "--msh: got an empty name; expected that of a file"},
        Wrong{"column.toml -o .", 4, "suffuse-mesher: error: "},
        Wrong{"column.toml --set ''", 2, "--set : expected KEY=VALUE"},
        Wrong{"column.toml --set \"$(printf 'time.end=\\377')\"", 2, "--set time.end="},
        Wrong{"column.toml -o nowhere/a.case.h5", 4, "there is no folder nowhere"},
        Wrong{"column.toml --msh nowhere/a.msh", 4, "there is no folder nowhere"}));

TEST_F(CommandLine, AGeometryThatGmshCannotReadIsPlaced) {
  // Each file needs its own process: Gmsh's parser does not recover from an error.
  folder_.write("bad.toml", test::scene_text("[geometry]\nfile = \"" + test::data_folder() +
                                             "/geometry/syntax_error.geo\"\n[mesh]\nsize = 0.5\n"));
  const Outcome outcome = run("bad.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.text,
            test::data_folder() +
                "/geometry/syntax_error.geo:12: got syntax error (=); expected valid Gmsh text\n");
  EXPECT_EQ(folder_.count(), 2);
}

TEST_F(CommandLine, AFullDiskIsAFileFailureAndLeavesNothing) {
  const Outcome outcome = run("column.toml", "trap '' XFSZ && ulimit -f 8");
  EXPECT_EQ(outcome.code, 4) << outcome.text;
  EXPECT_NE(outcome.text.find("is the disk full?"), std::string::npos) << outcome.text;
  EXPECT_EQ(folder_.count(), 1);
}

TEST_F(CommandLine, AnUnwritableOutputIsAFileFailureAndLeavesNothing) {
  const Outcome outcome = run("column.toml -o /proc/a.case.h5");
  EXPECT_EQ(outcome.code, 4) << outcome.text;
  EXPECT_NE(outcome.text.find("/proc/"), std::string::npos);
  EXPECT_EQ(folder_.count(), 1);
}

}  // namespace command_line_test
}  // namespace suffuse
