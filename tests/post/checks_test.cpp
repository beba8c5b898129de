/// `suffuse-post check` on runs whose heads are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "checks/checks.hpp"
#include "checks/heave_safety.hpp"
#include "checks/sellmeijer.hpp"
#include "common/errors.hpp"
#include "post/check_scenes.hpp"
#include "post/run_programs.hpp"
#include "report/report.hpp"

namespace suffuse {
namespace checks_test {

using testing::bulk_weight;
using testing::heads;
using testing::levee_ground;
using testing::levee_scene;
using testing::row_of;
using testing::run_programs;
using testing::sand_sizes;
using testing::ScratchFolder;
using testing::soil;
using testing::top;
using testing::two_layers;
using testing::water;

/// A column of 3.2 m with water that rises through it; a threshold of 0.4 of the gradient.
ResultsReader rising_water(const ScratchFolder& scratch, double excess, double on_top = 0.0) {
  return run_programs(
      scratch, "column",
      top("geometry = { shape = \"column\", width = 0.4, height = 3.2 }\nmesh.size = 0.2\n") +
          soil("specimen", 1e-4,
               "erosion = { law = \"first-order\", rate = 1e-9, drive = \"gradient\", threshold = "
               "0.4 }\n") +
          heads(3.2 + on_top + excess, 3.2 + on_top));
}

TEST(Checks, HeaveOfAColumnIsExact) {
  const ScratchFolder scratch;
  const ResultsReader results = rising_water(scratch, 0.9363);
  const CheckReport report = check_run(results, results.scene().scene.check);
  const CheckRow& stresses = row_of(report, "hyd-stresses", "top");
  EXPECT_NEAR(stresses.effect, 1.35 * (3.2 + 0.9363) * water, 1e-3);
  EXPECT_NEAR(stresses.resistance, 0.9 * 3.2 * bulk_weight, 1.0);
  EXPECT_NEAR(stresses.place[1], 0.0, 1e-9);
  const CheckRow& forces = row_of(report, "hyd-forces", "top");
  EXPECT_NEAR(forces.effect, 1.35 * 0.9363 * water, 1e-3);
  EXPECT_NEAR(forces.resistance, 0.9 * 3.2 * (bulk_weight - water), 1.0);
  EXPECT_NEAR(*row_of(report, "erosion").factor, 0.4 * 3.2 / 0.9363, 1e-9);
  EXPECT_NEAR(*row_of(report, "heave").factor, 0.65 * 1.519649 * 3.2 / 0.9363, 1e-9);
}

/// Water that stands on the ground presses on soil and pores alike.
TEST(Checks, WaterOnTheGroundChangesNothing) {
  const ScratchFolder scratch;
  const ResultsReader results = rising_water(scratch, 0.9363, 5.0);
  const CheckReport report = check_run(results, results.scene().scene.check);
  EXPECT_NEAR(row_of(report, "hyd-stresses").effect, 1.35 * (3.2 + 0.9363) * water, 1e-3);
  EXPECT_NEAR(row_of(report, "hyd-forces").effect, 1.35 * 0.9363 * water, 1e-3);
}

TEST(Checks, SettingsChangeAfterTheRun) {
  const ScratchFolder scratch;
  const ResultsReader results = rising_water(scratch, 0.9363);
  const auto with = [&](const std::string& change) {
    return check_run(results, check_settings(results, {change}));
  };
  EXPECT_NEAR(row_of(with("check.heave.destabilising=1.0"), "hyd-forces").effect, 0.9363 * water,
              1e-3);
  EXPECT_NO_THROW(require_limit_states(with("check.heave.destabilising=1.0")));
  EXPECT_THROW(require_limit_states(with("check.heave.destabilising=2.0")), NumericalError);
  EXPECT_THROW(check_settings(results, {"soil.specimen.porosity=0.3"}), InputError);
  EXPECT_THROW(check_settings(results, {"check.heave.stabilizing=1.0"}), InputError);
}

/// A flood with its peak of 4.4 m at 0.4 s, between the rows.
std::string flood(double every) {
  std::ostringstream text;
  text << "formulation = \"single-point\"\ngravity = [0.0, -9.81]\n"
       << "geometry = { shape = \"column\", width = 0.4, height = 3.2 }\nmesh.size = 0.4\n"
       << "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
       << "initial.flow = \"steady\"\ntime.end = 1.0\noutput.every = " << every << "\n"
       << soil("specimen", 1e-4)
       << "[[boundary]]\non = \"bottom\"\nhead = [[0, 3.4], [0.4, 4.4], [0.5, 4.396], [1, 3.2]]\n"
       << "concentration = 0.0\n[[boundary]]\non = \"top\"\nhead = 3.2\nconcentration = 0.0\n";
  return text.str();
}

TEST(Checks, NameThePeakThatNoSnapshotHas) {
  const ScratchFolder scratch;
  const ResultsReader results = run_programs(scratch, "flood", flood(1.0));
  const std::string sentence =
      "the highest head at \"bottom\", 4.4 m at t = 0.4 s, is between snapshots, which have at "
      "most "
      "3.4 m; a smaller output.snapshot_every shows it";
  const CheckReport report = check_run(results, results.scene().scene.check);
  EXPECT_EQ(report.unseen_peaks, std::vector{sentence});
  EXPECT_NE(check_text(report).find("not looked at:\n  " + sentence + "\n"), std::string::npos);
  write_report({results}, scratch / "report.html", {});
  EXPECT_NE(testing::file_text(scratch / "report.html").find("is between snapshots, which have"),
            std::string::npos);
  const std::string said = scratch / "said";
  testing::run_command(
      "$PROGRAMS/suffuse-post check " + results.folder() + " --csv - > /dev/null 2> " + said, said);
  EXPECT_EQ(testing::file_text(said), "suffuse-post: warning: not looked at: " + sentence + "\n");
  // The snapshot at 0.5 s misses 0.004 m, less than 1 % of the range.
  const ResultsReader close = run_programs(scratch, "close", flood(0.5));
  EXPECT_TRUE(check_run(close, close.scene().scene.check).unseen_peaks.empty());
}

/// Water that sinks lifts nothing.
TEST(Checks, SinkingWaterHasNoHeave) {
  const ScratchFolder scratch;
  const ResultsReader results = rising_water(scratch, -0.9);
  const CheckReport report = check_run(results, results.scene().scene.check);
  for (const CheckRow& row : report.rows) {
    EXPECT_FALSE(row.mechanism.starts_with("hyd-")) << row.where;
  }
}

constexpr const char* gravel_sizes = "gradation = [[1.0, 0], [3.0, 15], [20.0, 100]]\n";

ResultsReader layers(const ScratchFolder& scratch, double bottom, double above) {
  return run_programs(scratch, "layers",
                      top("geometry.file = \"layers.geo\"\nmesh.size = 0.1\n") +
                          "check.uplift.cover = \"clay\"\n" + soil("sand", 1e-4, sand_sizes) +
                          soil("clay", 1e-5, gravel_sizes) + heads(bottom, above),
                      two_layers());
}

/// The cover takes 10 of 11 parts of the difference of head.
TEST(Checks, UpliftOfACoverIsExact) {
  const ScratchFolder scratch;
  const ResultsReader results = layers(scratch, 3.1, 2.0);
  const CheckReport report = check_run(results, results.scene().scene.check);
  const CheckRow& row = row_of(report, "uplift", "top");
  EXPECT_NEAR(row.effect, (1.0 + 1.0) * water, 1e-3);
  EXPECT_NEAR(row.resistance, 0.9 * bulk_weight, 1.0);
  EXPECT_NEAR(row.place[1], 1.0, 1e-9);
}

/// The same flow with pressures from another datum has the same factors.
TEST(Checks, WithoutGravityTheDatumOfPressureDoesNotMatter) {
  std::array<double, 2> factor{};
  for (int i = 0; i < 2; ++i) {
    const ScratchFolder scratch;
    const double datum = i == 0 ? 0.0 : -3e4;
    std::ostringstream boundary;
    boundary << "boundary = [{ on = \"bottom\", pressure = " << 1e4 + datum
             << ", concentration = 0.0 }, { on = \"top\", pressure = " << datum << " }]\n";
    const ResultsReader results = run_programs(
        scratch, "column",
        "formulation = \"single-point\"\ngravity = [0.0, 0.0]\n"
        "geometry = { shape = \"column\", width = 0.4, height = 3.2 }\nmesh.size = 0.2\n"
        "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n" +
            boundary.str() + "initial.flow = \"steady\"\ntime.end = 1.0\noutput.every = 1.0\n" +
            soil("specimen", 1e-4));
    const CheckReport report = check_run(results, results.scene().scene.check);
    factor[i] = *row_of(report, "hyd-forces").factor;
    EXPECT_NE(safety_text(results, safety_of(results), {}).find("in a plan"), std::string::npos);
  }
  EXPECT_NEAR(factor[0], 0.9 * 3.2 * (bulk_weight - water) / (1.35 * 1e4), 1e-3);
  EXPECT_NEAR(factor[1], factor[0], 1e-9 * factor[0]);
}

/// The soil that water leaves is the base, the soil that it enters the filter.
TEST(Checks, FiltersFollowTheFlow) {
  const ScratchFolder scratch;
  const ResultsReader rising = layers(scratch, 3.1, 2.0);
  const CheckReport up = check_run(rising, rising.scene().scene.check);
  const CheckRow& filter = row_of(up, "filter", "sand -> clay");
  EXPECT_NEAR(filter.effect, 3.0, 1e-12);
  EXPECT_NEAR(filter.resistance, 7.0, 1e-12);
  EXPECT_TRUE(filter.note.starts_with("no erosion")) << filter.note;
  EXPECT_NEAR(*row_of(up, "filter-retention").factor, 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(*row_of(up, "filter-drainage").factor, 30.0 / 4.0, 1e-12);
  const ScratchFolder other;
  const ResultsReader sinking = layers(other, 1.0, 2.0);
  const CheckReport down = check_run(sinking, sinking.scene().scene.check);
  EXPECT_EQ(row_of(down, "filter").where, "clay -> sand");
}

/// Through one cover water enters the sand on the riverside and leaves it on the landside: both
/// contacts are filters.
TEST(Checks, AContactThatWaterCrossesBothWaysIsJudgedTwice) {
  const ScratchFolder scratch;
  std::string scene = levee_scene("");
  scene.replace(scene.find("[soil.clay]\n"), 12, std::string("[soil.clay]\n") + gravel_sizes);
  const ResultsReader results = run_programs(scratch, "levee", scene, levee_ground());
  const CheckReport report = check_run(results, results.scene().scene.check);
  EXPECT_NEAR(*row_of(report, "filter", "sand -> clay").factor, 7.0 / 3.0, 1e-12);
  EXPECT_NO_THROW(row_of(report, "filter", "clay -> sand"));
  // Sand is finer than gravel, and is not there to drain it.
  EXPECT_EQ(row_of(report, "filter-drainage").where, "sand -> clay");
}

/// A soil whose coarse grains do not hold its fines, here the finest 22.7 %: the filter has to hold
/// these alone. With sizes in mm, D85 of the fines is 0.2254 mm.
TEST(Checks, TheBaseOfAnUnstableSoilIsItsFines) {
  const std::string gap_sizes =
      "gradation = [[0.08, 0], [0.15, 10], [0.25, 22], [2.0, 24], [4.0, 40], [8.0, 75], [16.0, "
      "100]]\n";
  const std::string fine_sizes =
      "gradation = [[0.06, 0], [0.1, 10], [0.15, 40], [0.2, 70], [0.3, 95], [0.5, 100]]\n";
  const ScratchFolder scratch;
  std::string scene = levee_scene("");
  scene.replace(scene.find(sand_sizes), std::string(sand_sizes).size(), gap_sizes);
  scene.replace(scene.find("[soil.clay]\n"), 12, std::string("[soil.clay]\n") + fine_sizes);
  const ResultsReader results = run_programs(scratch, "levee", scene, levee_ground());
  const CheckReport report = check_run(results, results.scene().scene.check);
  const CheckRow& gap = row_of(report, "internal-stability", "sand");
  EXPECT_LT(*gap.factor, 0.1);
  EXPECT_TRUE(gap.note.starts_with("unstable; Kezdi (1979): unstable")) << gap.note;
  EXPECT_GT(*row_of(report, "internal-stability", "clay").factor, 2.0);
  const CheckRow& filter = row_of(report, "filter", "sand -> clay");
  const double d15 = 0.1 * std::pow(1.5, 5.0 / 30.0);
  EXPECT_NEAR(filter.effect, d15, 1e-9);
  // F* = 22.7 %: its 85 % are at F = 19.3 %, between 0.15 and 0.25 mm.
  const double fines = 22.0 + 2.0 * std::log(0.5 / 0.25) / std::log(8.0);
  const double d85 = 0.15 * std::pow(0.25 / 0.15, (0.85 * fines - 10.0) / 12.0);
  EXPECT_NEAR(filter.resistance, 7.0 * d85, 1e-6);
  EXPECT_NE(filter.note.find("the base is the finest 22.7 % of sand"), std::string::npos);
  EXPECT_NEAR(*row_of(report, "filter-retention", "sand -> clay").factor, 4.0 * d85 / d15, 1e-6);
}

/// Water that leaves through a seepage face has the pressure of the air. This holds at the node of
/// a toe too, where two seepage faces meet, and the check of a column below it starts from there.
TEST(Checks, NodesOfSeepageFacesHaveNoPressure) {
  const ScratchFolder scratch;
  const std::string geometry =
      "Point(1) = {0, -6, 0}; Point(2) = {30, -6, 0}; Point(3) = {30, 0, 0};\n"
      "Point(4) = {20, 0, 0}; Point(5) = {10, 4, 0}; Point(6) = {0, 4, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};\n"
      "Line(5) = {5, 6}; Line(6) = {6, 1};\n"
      "Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};\n"
      "Physical Surface(\"sand\") = {1}; Physical Curve(\"river\") = {6};\n"
      "Physical Curve(\"slope\") = {4}; Physical Curve(\"ground\") = {3};\n";
  const ResultsReader results = run_programs(
      scratch, "toe",
      top("geometry.file = \"toe.geo\"\nmesh.size = 1.0\nmesh.structure = \"crossed\"\n") +
          soil("sand", 1e-4, "retention = { model = \"gardner\", alpha = 2.0 }\n") +
          "[[boundary]]\non = \"river\"\nhead = 3.4\nconcentration = 0.0\n"
          "[[boundary]]\non = \"slope\"\nseepage_face = true\n"
          "[[boundary]]\non = \"ground\"\nseepage_face = true\n",
      geometry);
  const std::vector<double> pressure = results.field(0, "node", "pressure").values;
  with_mesh(results, [&](const auto& mesh) {
    for (const auto& boundary : mesh.boundaries) {
      if (boundary.name != "slope" && boundary.name != "ground") continue;
      for (const auto& face : boundary.faces) {
        for (const int node : face) EXPECT_LE(pressure[node], 0.0) << mesh.nodes[node].transpose();
      }
    }
  });
  const CheckReport report = check_run(results, results.scene().scene.check);
  const CheckRow& column = row_of(report, "hyd-stresses", "ground");
  // Effect and gradient of one place agree.
  EXPECT_LT(column.effect, 1.35 * water * -column.place[1] * 2.0);
}

TEST(Checks, BlanketTheoryStandsNextToTheComputedHead) {
  const ScratchFolder scratch;
  const ResultsReader results = run_programs(
      scratch, "levee",
      levee_scene("check.blanket = { aquifer = \"sand\", cover = \"clay\", entry = \"river\", "
                  "riverside_toe = 0.0, landside_toe = 20.0, riverside = \"closed\", landside = "
                  "\"closed\" }\n"),
      levee_ground());
  const CheckReport report = check_run(results, results.scene().scene.check);
  const CheckRow& row = row_of(report, "blanket");
  const double c = std::sqrt(1e-6 / (1e-4 * 10.0 * 2.0));
  const double side = 1.0 / (c * std::tanh(100.0 * c));
  const double share = side / (2.0 * side + 20.0);
  EXPECT_NEAR(row.effect, share * 3.0 / 2.0, 1e-6);
  EXPECT_NEAR(row.resistance, 0.65 * 1.519649, 1e-9);
  const std::string before = "blanket theory, ";
  const double computed = std::stod(row.note.substr(row.note.find(before) + before.size()));
  EXPECT_NEAR(computed, share * 3.0, 0.03 * share * 3.0) << row.note;
}

/// Clay that is sealed on the landside: the river presses on its base from below, and nothing
/// stands on it. Water flows from the clay into the sand on the riverside, and leaves far away.
TEST(Checks, PressureBelowImperviousGroundIsNoWaterOnIt) {
  const ScratchFolder scratch;
  std::string scene = levee_scene("check.uplift.cover = \"clay\"\n");
  scene.replace(scene.find("on = \"land\""), 11, "on = \"far\"");
  std::string ground = levee_ground();
  ground += "Physical Curve(\"far\") = {2};\n";
  const ResultsReader results = run_programs(scratch, "levee", scene, ground);
  const CheckReport report = check_run(results, results.scene().scene.check);
  const CheckRow& row = row_of(report, "uplift", "ground of clay");
  // The worst place is x = 0, below the impervious ground next to the river. The aquifer from there
  // to its far end is 120 m long, and the riverside resists as x1 of it.
  const double c = std::sqrt(1e-6 / (1e-4 * 10.0 * 2.0));
  const double x1 = 1.0 / (c * std::tanh(100.0 * c));
  const double at_base = 3.0 * 120.0 / (120.0 + x1);
  EXPECT_NEAR(row.effect, (2.0 + at_base) * water, 0.03 * row.effect);
  EXPECT_NEAR(row.place[1], -2.0, 1e-6);
}

/// The sand has no face at the boundaries: the length must be given.
TEST(Checks, BackwardErosionNeedsALengthThatTheDrawingLacks) {
  const ScratchFolder scratch;
  const std::string check =
      "check.backward_erosion = { layer = \"sand\", entry = \"river\", exit = "
      "\"land\", roundness = 60.0";
  const ResultsReader results =
      run_programs(scratch, "levee", levee_scene(check + " }\n"), levee_ground());
  const CheckReport without = check_run(results, results.scene().scene.check);
  ASSERT_EQ(without.refused.size(), 1U);
  EXPECT_NE(without.refused[0].find("check.backward_erosion.length"), std::string::npos);
  // The other checks are made. H / F by Kenney and Lau is least at F = 20 %.
  const double finer = 0.1 * std::pow(3.0, 5.0 / 35.0);
  const double coarser = 50.0 + 35.0 * std::log(4.0 * finer / 0.3) / std::log(1.0 / 0.3);
  EXPECT_NEAR(*row_of(without, "internal-stability", "sand").factor, coarser / 20.0 - 1.0, 1e-9);
  EXPECT_EQ(std::ranges::count(without.rows, "backward-erosion", &CheckRow::mechanism), 0);
  EXPECT_THROW(require_all_checks(without), InputError);
  const CheckReport report =
      check_run(results, check_settings(results, {"check.backward_erosion.length=40.0",
                                                  "check.backward_erosion.thickness=10.0"}));
  const CheckRow& row = row_of(report, "backward-erosion");
  EXPECT_NEAR(row.effect, 3.0, 1e-9);
  const Gradation sizes(
      {{0.05, 0.0}, {0.1, 15.0}, {0.3, 50.0}, {1.0, 85.0}, {2.0, 95.0}, {4.0, 100.0}});
  const PipingLayer layer{.length = 40.0,
                          .thickness = 10.0,
                          .d70 = 1e-3 * sizes.size(70.0),
                          .permeability = 1e-4 * 1e-3 / 9810.0,
                          .relative_weight = 1.519649,
                          .uniformity = sizes.size(60.0) / sizes.size(10.0),
                          .roundness = 60.0};
  EXPECT_NEAR(row.resistance, critical_head(layer), 1e-9);
  EXPECT_NE(row.note.find("the tests had"), std::string::npos) << row.note;
}

/// Sand of 10 m that is open on both sides of a levee 20 m wide.
TEST(Checks, BackwardErosionMeasuresTheDrawing) {
  const ScratchFolder scratch;
  const std::string ground =
      "Point(1) = {-30, -10, 0}; Point(2) = {50, -10, 0}; Point(3) = {50, 0, 0};\n"
      "Point(4) = {20, 0, 0}; Point(5) = {0, 0, 0}; Point(6) = {-30, 0, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6};\n"
      "Line(6) = {6, 1}; Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};\n"
      "Physical Surface(\"sand\") = {1}; Physical Curve(\"land\") = {3};\n"
      "Physical Curve(\"river\") = {5};\n";
  const ResultsReader results = run_programs(
      scratch, "open",
      top("geometry.file = \"open.geo\"\nmesh.size = 2.0\n") +
          "check.backward_erosion = { layer = \"sand\", entry = \"river\", exit = \"land\", d70 = "
          "0.2 }\n" +
          soil("sand", 1e-4) +
          "[[boundary]]\non = \"river\"\nhead = 2.0\nconcentration = 0.0\n"
          "[[boundary]]\non = \"land\"\nhead = 0.0\nconcentration = 0.0\n",
      ground);
  const CheckRow row = row_of(check_run(results, results.scene().scene.check), "backward-erosion");
  EXPECT_TRUE(row.note.starts_with("L = 20 m, D = 10 m")) << row.note;
  EXPECT_NEAR(row.effect, 2.0, 1e-9);
}

/// The column under an excess head that rises by 1 m each second to 4 m, and falls again.
ResultsReader flood_wave(const ScratchFolder& scratch) {
  std::string scene =
      top("geometry = { shape = \"column\", width = 0.4, height = 3.2 }\nmesh.size = 0.2\n") +
      soil("specimen", 1e-4,
           "erosion = { law = \"first-order\", rate = 1e-9, drive = \"gradient\", threshold = "
           "0.4 }\n") +
      "[[boundary]]\non = \"bottom\"\nhead = [[0.0, 3.2], [4.0, 7.2], [8.0, 3.2]]\n"
      "concentration = 0.0\n[[boundary]]\non = \"top\"\nhead = 3.2\nconcentration = 0.0\n";
  scene.replace(scene.find("time.end = 1.0"), 14, "time.end = 8.0");
  return run_programs(scratch, "wave", scene);
}

/// The excess heads with a factor of 1 are 1.04 m (2.9a), 1.28 m (the threshold), 2.11 m (2.9b) and
/// 3.16 m (i_cr); the largest, 4 m, comes after 4 s.
TEST(Checks, SayWhenAFactorWasBelowOneForTheFirstTime) {
  const ScratchFolder scratch;
  const ResultsReader results = flood_wave(scratch);
  const CheckReport report = check_run(results, results.scene().scene.check);
  for (const auto& [mechanism, first] : std::vector<std::pair<std::string, double>>{
           {"hyd-stresses", 2.0}, {"erosion", 2.0}, {"hyd-forces", 3.0}, {"heave", 4.0}}) {
    const CheckRow& row = row_of(report, mechanism);
    EXPECT_NEAR(row.first_below, first, 1e-9) << mechanism;
    EXPECT_NEAR(row.time, 4.0, 1e-9) << mechanism;
  }
  EXPECT_NE(check_text(report).find(
                "\nhyd-forces, top: the factor is below 1 for the first time at t = 3 s\n"),
            std::string::npos);
  EXPECT_NE(safety_text(results, safety_of(results))
                .find("lifts soil that nothing holds down, for the first time at t = 4 s: from "
                      "then on results"),
            std::string::npos);
  const std::string table = check_table(report, 2, TimeUnit{"min", 60.0});
  EXPECT_TRUE(table.starts_with(
      "mechanism,where,clause,t [min],effect,resistance,unit,factor,x,y,note,t_below_1 [min]\n"));
  EXPECT_NE(table.find(",0.05\n"), std::string::npos) << table;
}

/// The command, with what it prints.
std::string said_by_check(const ScratchFolder& scratch, const std::string& arguments) {
  const std::string command = test::program_folder() + "/suffuse-post check " + arguments + " > " +
                              scratch / "said" + " 2>&1";
  EXPECT_NE(std::system(command.c_str()), -1);
  return testing::file_text(scratch / "said");
}

TEST(Checks, TimesHaveTheUnitOfChoice) {
  const ScratchFolder scratch;
  const std::string folder = flood_wave(scratch).folder();
  const std::string text = said_by_check(scratch, folder + " --time-unit min");
  EXPECT_NE(text.find("until t = 0.13333333333333333 min\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  t (min)  "), std::string::npos) << text;
  EXPECT_EQ(text.find("\033"), std::string::npos) << "a file is no terminal";
  EXPECT_EQ(said_by_check(scratch, folder + " --csv -").find("mechanism,where,clause,t,effect,"),
            0U);
  EXPECT_EQ(said_by_check(scratch, folder + " --csv - --time-unit h")
                .find("mechanism,where,clause,t [h],effect,"),
            0U);
  EXPECT_EQ(said_by_check(scratch, folder + " --time-unit hours"),
            "suffuse-post check: --time-unit: got \"hours\"; expected \"s\", \"min\", \"h\", "
            "\"d\" or \"a\"\n");
}

/// Under 1.5 m of head the column passes 2.9a and the threshold of erosion alone.
TEST(Checks, ExceededLimitsComeFirstAndAreBold) {
  const ScratchFolder scratch;
  const ResultsReader results = rising_water(scratch, 1.5);
  const CheckReport report = check_run(results, results.scene().scene.check);
  const std::string plain = check_text(report);
  EXPECT_LT(plain.find("\nerosion "), plain.find("\nhyd-stresses "));
  EXPECT_LT(plain.find("\nhyd-stresses "), plain.find("\nheave "));
  EXPECT_LT(plain.rfind("EXCEEDED"), plain.find(" kept "));
  const std::string colored = check_text(report, {.colors = true});
  EXPECT_NE(colored.find("\n\033[1;31mhyd-stresses "), std::string::npos);
  EXPECT_NE(colored.find("\nheave "), std::string::npos);
  const std::string page = report_html({results});
  EXPECT_NE(page.find("<tr class=\"exceeded\"><td>erosion</td>"), std::string::npos);
  EXPECT_NE(page.find("<tr class=\"exceeded\"><td>hyd-stresses</td>"), std::string::npos);
  EXPECT_NE(page.find("<tr><td>heave</td>"), std::string::npos);
  EXPECT_NE(page.find(".exceeded td { color: var(--alarm); font-weight: 700; }"),
            std::string::npos);
}

/// Under 2.5 m of head the column heaves, which the first page of the report says.
TEST(Checks, TheReportBeginsWithThem) {
  const ScratchFolder scratch;
  const std::string page = report_html({rising_water(scratch, 2.5)});
  EXPECT_LT(page.find("<table class=\"mechanisms\">"), page.find("id=\"curves\""));
  EXPECT_NE(page.find("EXCEEDED"), std::string::npos);
  EXPECT_NE(page.find("The error of the mesh is not known"), std::string::npos);
  EXPECT_NE(page.find("breach: the slope"), std::string::npos);
}

TEST(Checks, TheTableHasARowForEachAndTheTextSaysWhatIsMissing) {
  const ScratchFolder scratch;
  const ResultsReader results = layers(scratch, 3.1, 2.0);
  const CheckReport report = check_run(results, results.scene().scene.check);
  const std::string table = check_table(report, 2);
  EXPECT_TRUE(table.starts_with(
      "mechanism,where,clause,t,effect,resistance,unit,factor,x,y,note,t_below_1\n"));
  EXPECT_EQ(std::ranges::count(table, '\n'), static_cast<long>(report.rows.size()) + 1);
  const std::string text = check_text(report);
  EXPECT_NE(text.find("suffusion (no soil erodes)"), std::string::npos) << text;
  EXPECT_NE(text.find("backward erosion (key check.backward_erosion.layer)"), std::string::npos);
  EXPECT_EQ(text.find("uplift of a cover (key"), std::string::npos);
}

}  // namespace checks_test
}  // namespace suffuse
