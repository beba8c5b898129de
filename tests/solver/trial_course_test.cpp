#include "tools/trial_course.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace suffuse {
namespace trial_course_test {

TEST(TrialCourse, EqualStepsGoOnAsTheyAre) {
  TrialCourse course{{{0.0, 0.0, 3.0}}};  // 3 s to set the model up
  for (int i = 1; i <= 100; ++i) course.marks.push_back({0.1 * i, 2.0 * i, 3.0 + 0.4 * i});
  EXPECT_NEAR(course.steps_to_go(1e9, 50.0), 40.0 / 0.05, 1e-9);
  EXPECT_NEAR(course.seconds_per_step(), 0.2, 1e-12);
}

/// A flow that settles: each step is a tenth of the time since the start.
TEST(TrialCourse, GrowingStepsGoOnGrowingUntilTheyAreLongest) {
  TrialCourse course{{{}}};
  double time = 1e-3;
  for (int i = 1; time < 1.0; ++i, time *= 1.1) {
    course.marks.push_back({time, static_cast<double>(i), 0.0});
  }
  const double last = course.last().time;
  const double growing = std::log(100.0 / last) / std::log(1.1);
  EXPECT_NEAR(course.steps_to_go(1e9, 100.0), growing, 0.15 * growing);
  // steps are 1 s long from t = 10 s on
  const double capped = std::log(10.0 / last) / std::log(1.1) + 990.0;
  EXPECT_NEAR(course.steps_to_go(1.0, 1000.0), capped, 0.02 * capped);
}

TEST(TrialCourse, OneIntervalIsAllThereIs) {
  const TrialCourse course{{{0.0, 0.0, 1.0}, {0.5, 4.0, 2.0}}};
  EXPECT_DOUBLE_EQ(course.steps_to_go(1e9, 2.0), 12.0);
  EXPECT_DOUBLE_EQ(course.seconds_per_step(), 0.25);
}

}  // namespace trial_course_test
}  // namespace suffuse
