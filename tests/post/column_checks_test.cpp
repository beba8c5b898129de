/// Heave and uplift of columns in `suffuse-post check`.

#include <gtest/gtest.h>

#include <sstream>

#include "common/errors.hpp"
#include "post/check_scenes.hpp"
#include "post/run_programs.hpp"

namespace suffuse {
namespace column_checks_test {

using testing::bulk_weight;
using testing::heads;
using testing::row_of;
using testing::run_programs;
using testing::ScratchFolder;
using testing::soil;
using testing::top;
using testing::two_layers;
using testing::water;

/// A wall that leaks a little lies between sand and the clay above it, and takes nearly all of the
/// difference of head of 1.1 m. The clay is lifted by the pressure below the wall.
TEST(ColumnChecks, TheLargerPressureActsOnAWallAtTheBase) {
  const ScratchFolder scratch;
  const ResultsReader results =
      run_programs(scratch, "liner",
                   top("geometry.file = \"liner.geo\"\nmesh.size = 0.1\n") +
                       "check.uplift.cover = \"clay\"\n" + soil("sand", 1e-4) + soil("clay", 1e-5) +
                       heads(3.1, 2.0) + "[[wall]]\non = \"liner\"\nconductance = 1e-9\n",
                   two_layers() + "Physical Curve(\"liner\") = {3};\n");
  const CheckReport report = check_run(results, results.scene().scene.check);
  const double excess = 1.1 * (1e9 + 1e5) / (1e9 + 1e5 + 1e4) * water;
  const CheckRow& lifted = row_of(report, "uplift", "top");
  EXPECT_NEAR(lifted.effect, 1.0 * water + excess, 1e-3);
  EXPECT_NEAR(lifted.resistance, 0.9 * bulk_weight, 1.0);
  const CheckRow& stresses = row_of(report, "hyd-stresses", "top");
  EXPECT_NEAR(stresses.effect, 1.35 * (1.0 * water + excess), 1e-3);
  EXPECT_NEAR(stresses.place[1], 1.0, 1e-9);
  const CheckRow& forces = row_of(report, "hyd-forces", "top");
  EXPECT_NEAR(forces.effect, 1.35 * excess, 1e-3);
  EXPECT_NEAR(forces.place[1], 1.0, 1e-9);
}

/// The two layers with ground that is not saturated. The head below the clay, which is tight, rises
/// from 1 m to `river` before the clay follows.
ResultsReader dry_cover(const ScratchFolder& scratch, double river) {
  std::ostringstream scene;
  scene << "formulation = \"single-point\"\ngravity = [0.0, -9.81]\n"
        << "geometry.file = \"dry.geo\"\nmesh.size = 0.1\n"
        << "liquid = { density = 1000.0, bulk_modulus = 2e9, viscosity = 1e-3 }\n"
        << "initial.water_level = 1.0\ntime.end = 100.0\noutput.every = 100.0\n"
        << soil("sand", 1e-3)
        << soil("clay", 1e-10, "retention = { model = \"van-genuchten\", alpha = 2.0, n = 1.6 }\n")
        << "[[boundary]]\non = \"bottom\"\nhead = [[0.0, 1.0], [100.0, " << river << "]]\n"
        << "[[boundary]]\non = \"top\"\nseepage_face = true\n";
  return run_programs(scratch, "dry", scene.str(), two_layers());
}

/// No water leaves through the tight cover, but that below it would rise above the ground by 1.5 m.
TEST(ColumnChecks, TightAndDryGroundHeavesByTotalStresses) {
  const ScratchFolder scratch;
  const ResultsReader results = dry_cover(scratch, 3.5);
  const CheckReport report = check_run(results, results.scene().scene.check);
  const CheckRow& row = row_of(report, "hyd-stresses", "top");
  EXPECT_NEAR(row.place[1], 1.0, 0.1);
  EXPECT_NEAR(row.effect, 1.35 * (3.5 - row.place[1]) * water, 1e-3 * row.effect);
  EXPECT_LT(*row.factor, 1.0);
  EXPECT_THROW(require_limit_states(report), NumericalError);
  EXPECT_THROW(row_of(report, "hyd-forces"), std::runtime_error);
  EXPECT_NE(check_text(report).find("heave by EN 1997-1, 2.9b (water leaves through no ground)"),
            std::string::npos);
}

/// Water below the ground that does not reach up to it lifts nothing.
TEST(ColumnChecks, WaterThatStaysBelowTheGroundHasNoHeave) {
  const ScratchFolder scratch;
  const ResultsReader results = dry_cover(scratch, 1.9);
  const CheckReport report = check_run(results, results.scene().scene.check);
  EXPECT_THROW(row_of(report, "hyd-stresses"), std::runtime_error);
}

/// Water that stands still up to round-off: the pressure exceeds the hydrostatic one by 1e-9 m of
/// water.
TEST(ColumnChecks, RoundOffIsNoForce) {
  const ScratchFolder scratch;
  const ResultsReader results =
      run_programs(scratch, "still",
                   top("geometry.file = \"still.geo\"\nmesh.size = 0.1\n") + soil("sand", 1e-4) +
                       soil("clay", 1e-5) + heads(2.0 + 1e-9, 2.0),
                   two_layers());
  EXPECT_THROW(row_of(check_run(results, results.scene().scene.check), "hyd-forces"),
               std::runtime_error);
}

}  // namespace column_checks_test
}  // namespace suffuse
