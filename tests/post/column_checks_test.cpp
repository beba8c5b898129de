/// Heave and uplift of columns in `suffuse-post check`.

#include <gtest/gtest.h>

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

}  // namespace column_checks_test
}  // namespace suffuse
