/// The time left that progress reports.

#include "driver/progress.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace suffuse {
namespace progress_test {

TEST(TimeLeft, OfASteadyPaceIsKnownSoon) {
  TimeLeft left(0.0, 100.0);
  for (double elapsed = 0.01; elapsed < 10.0; elapsed += 0.01) {
    const std::optional<double> guess = left.at(elapsed, 10.0 * elapsed);
    if (elapsed < 0.5) continue;
    ASSERT_TRUE(guess) << elapsed;
    EXPECT_NEAR(*guess, 10.0 - elapsed, 1e-9);
  }
}

TEST(TimeLeft, OfARunThatWasResumedCountsFromThere) {
  TimeLeft left(90.0, 100.0);
  std::optional<double> guess;
  for (double elapsed = 0.01; elapsed < 5.0; elapsed += 0.01)
    guess = left.at(elapsed, 90.0 + elapsed);
  ASSERT_TRUE(guess);
  EXPECT_NEAR(*guess, 5.0, 0.1);
}

TEST(TimeLeft, IsUnknownWhileStepsGrow) {
  // Each step is a quarter longer than the one before, from 1e-10 s up to 1 s of 200 s, and takes
  // 0.05 s. The run takes 15.2 s.
  TimeLeft left(0.0, 200.0);
  double elapsed = 0.0;
  double step = 1e-10;
  int known = 0;
  for (double time = 0.0; time < 200.0; step = std::min(1.0, 1.25 * step)) {
    time += step;
    elapsed += 0.05;
    const std::optional<double> guess = left.at(elapsed, time);
    if (step < 0.5) {
      EXPECT_FALSE(guess) << "at t = " << time << " s: " << *guess << " s left";
    }
    if (!guess) continue;
    ++known;
    EXPECT_LE(*guess, 3.0 * std::max(0.0, 200.0 - time) * 0.05);
  }
  EXPECT_GT(known, 50);
}

TEST(TimeLeft, IsUnknownBeforeTimeAdvances) {
  TimeLeft left(0.0, 1.0);
  for (double elapsed = 0.1; elapsed < 5.0; elapsed += 0.1) EXPECT_FALSE(left.at(elapsed, 0.0));
}

TEST(Progress, SaysTheTimeLeftOrWhyItIsUnknown) {
  Standing standing{
      .time = 3e-9, .end = 200.0, .step = 4e-10, .first_step = 1e-10, .time_left = {}};
  EXPECT_EQ(outlook(standing), "steps grow from 1e-10 s");
  standing.from_rest = true;
  EXPECT_EQ(outlook(standing), "starting from rest: steps grow from 1e-10 s");
  standing.step = standing.first_step;
  EXPECT_EQ(outlook(standing), "time left not known yet");
  standing.time_left = 75.0;
  EXPECT_EQ(outlook(standing), "1:15 left");
  standing.time_left = 4000.0;
  EXPECT_EQ(outlook(standing), "1:06:40 left");
  standing.soil_fails = true;
  EXPECT_EQ(outlook(standing), "soil fails");
}

}  // namespace progress_test
}  // namespace suffuse
