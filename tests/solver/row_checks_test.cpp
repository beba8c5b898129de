/// Warnings about rows of the history: their time, their advice, and that each comes once.

#include "driver/row_checks.hpp"

#include <gtest/gtest.h>

#include "solver/double_point_case.hpp"

namespace suffuse {
namespace row_checks_test {

class Rows : public testing::Test {
 protected:
  [[nodiscard]] std::string warning(const HistoryRow& row) {
    const std::vector<std::string> warnings = checks_.check(row);
    return warnings.empty() ? "" : warnings.front();
  }
  static HistoryRow with_defect(double defect) {
    HistoryRow row;
    row.t = 12.0;
    row.volume_defect = defect;
    row.volume_defect_at = "element 7 at (0.5, 0.25)";
    return row;
  }
  static HistoryRow with_fines(double share, double concentration) {
    HistoryRow row;
    row.t = 12.0;
    row.fines_weight_share = share;
    row.concentration_max = concentration;
    return row;
  }

  Scene scene_ = model::paper_scene();
  RowChecks checks_{scene_};
};

/// The warning names place and time and comes once; a liquid that still flows raises none.
TEST_F(Rows, FinesThatLockAreToldOfOnce) {
  HistoryRow row = with_fines(0.0, 0.6);
  row.concentration_max_at = "element 7 at (0.5, 0.25)";
  EXPECT_EQ(warning(row), "");
  row.concentration_max = 0.64;
  const std::string text = warning(row);
  EXPECT_TRUE(
      text.starts_with("the liquid holds 0.64 of its volume in fines in element 7 at "
                       "(0.5, 0.25) at t = 12 s: "))
      << text;
  EXPECT_NE(text.find("critical_concentration"), std::string::npos);
  EXPECT_EQ(warning(row), "");
}

TEST_F(Rows, AVolumeDefectBeyondChanceIsToldOfOnce) {
  scene_.points.liquid_per_element = 12;
  EXPECT_EQ(warning(with_defect(1.4)), "");
  const std::string text = warning(with_defect(3.0));
  EXPECT_EQ(text,
            "liquid points have 4 times the volume of the pores in element 7 at (0.5, 0.25) at t = "
            "12 s: a volume_defect of 3, where up to 1.4 is usual with liquid_per_element = 12. "
            "Points that come from large elements do not fit into small ones: make the elements "
            "more even, or take more points. Masses stay exact; concentrations there are rough");
  EXPECT_EQ(warning(with_defect(4.0)), "");
}

TEST_F(Rows, FewerPointsAreLessEven) {
  scene_.points.liquid_per_element = 1;
  EXPECT_EQ(warning(with_defect(4.9)), "");
  EXPECT_NE(warning(with_defect(5.1)), "");
  scene_.points.liquid_per_element = 400;
  RowChecks many(scene_);
  EXPECT_TRUE(many.check(with_defect(0.99)).empty());
  EXPECT_FALSE(many.check(with_defect(1.01)).empty());
}

TEST_F(Rows, FinesThatDriveTheFlowAreToldOfOnce) {
  EXPECT_EQ(warning(with_fines(0.49, 0.1)), "");
  EXPECT_EQ(warning(with_fines(1.0, 0.9e-3)), "") << "of next to nothing";
  const std::string text = warning(with_fines(0.56, 0.026));
  EXPECT_TRUE(
      text.starts_with("the weight of fluidised fines drives the flow more than the "
                       "boundaries do: 56 % of its power at t = 12 s, with concentrations "
                       "up to 0.026."))
      << text;
  EXPECT_EQ(warning(with_fines(0.9, 0.1)), "");
}

TEST_F(Rows, SoilThatFailsAndComesToRestIsToldOf) {
  // The share of inertia in the loads is 0 in the step in which inertia starts.
  const auto row = [](double t, double failure, bool has_inertia) {
    HistoryRow result;
    result.t = t;
    result.failure_time = failure;
    result.has_failed = failure > 0.0 || has_inertia;
    result.has_inertia = has_inertia;
    return result;
  };
  const std::string from_there =
      " s; from there on it moves with its inertia, until it has come to rest";
  EXPECT_EQ(warning(row(0.0, 0.0, false)), "");
  EXPECT_EQ(warning(row(2.0, 1.5, true)),
            "the soil has lost its equilibrium at t = 1.5" + from_there);
  EXPECT_EQ(warning(row(3.0, 1.5, true)), "");
  EXPECT_EQ(warning(row(4.0, 1.5, false)), "the soil has come to rest by t = 4 s");
  EXPECT_EQ(warning(row(5.0, 1.5, false)), "");
  EXPECT_EQ(warning(row(7.0, 6.0, false)),
            "the soil has lost its equilibrium at t = 6" + from_there + ", by t = 7 s");
  EXPECT_EQ(warning(row(8.0, 6.0, false)), "");
  RowChecks of_column(scene_);  // it falls from the start on
  EXPECT_TRUE(of_column.check(row(0.0, 0.0, false)).empty());
  EXPECT_TRUE(of_column.check(row(1.0, 0.0, true)).empty());
  EXPECT_EQ(of_column.check(row(2.0, 0.0, false)).size(), 1U);
}

/// Motion is watched in equilibrium only: a run tells of soil that fails.
TEST_F(Rows, SoilThatMovesFarInEquilibriumMaySlide) {
  RowChecks levee(scene_, {.watched_motion = 0.045});  // of soil 4.5 m high
  HistoryRow row;
  row.t = 17500.0;
  row.displacement_max = 0.0449;
  EXPECT_TRUE(levee.check(row).empty());
  row.displacement_max = 0.0697;
  const std::vector<std::string> warnings = levee.check(row);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "the soil has moved by 0.07 m in equilibrium by t = 17500 s, more than 1 % of its "
            "height: it may slide slowly, and a moment at which it fails depends on the mesh; "
            "--strength-reduction --state finds its factor of safety");
  EXPECT_TRUE(levee.check(row).empty());
  RowChecks failed(scene_, {.watched_motion = 0.045});
  row.failure_time = 17000.0;
  row.has_failed = row.has_inertia = true;
  ASSERT_EQ(failed.check(row).size(), 1U);
  row.has_inertia = false;
  ASSERT_EQ(failed.check(row).size(), 1U);
  RowChecks at_start(scene_, {.watched_motion = 0.045});
  row.failure_time = 0.0;
  EXPECT_TRUE(at_start.check(row).empty()) << "it fell at the start";
}

TEST_F(Rows, WhatWasSaidIsRememberedAcrossAResume) {
  ASSERT_NE(warning(with_defect(30.0)), "");
  ASSERT_NE(warning(with_fines(0.9, 0.1)), "");
  StateArchive saved;
  checks_.archive(saved);
  StateArchive stored(saved.finish());
  RowChecks resumed(scene_);
  resumed.archive(stored);
  EXPECT_TRUE(resumed.check(with_defect(30.0)).empty());
  EXPECT_TRUE(resumed.check(with_fines(0.9, 0.1)).empty());
}

}  // namespace row_checks_test
}  // namespace suffuse
