/// Soil that loses its equilibrium again and again without moving far.

#include "coupling/repeated_failure.hpp"

#include <gtest/gtest.h>

#include "results/state_archive.hpp"
#include "solid/skeleton.hpp"

namespace suffuse {
namespace repeated_failure_test {

constexpr double size = 0.5;  // of elements, m
constexpr double fall = 1.0;  // s

/// Two points; the second one moves.
struct Slope {
  RepeatedFailure<2> failure;
  std::vector<Vector<2>> position{{0.0, 0.0}, {3.0, 1.0}};
  double time = 100.0;

  /// The slope fails, moves by `way` within a second, rests, and stands for `standing` seconds.
  void fail(double way, double standing) {
    failure.fails(time, position, size);
    position[1][0] += way;
    time += fall;
    failure.rests(time, fall);
    time += standing;
  }
  /// The number of the failure at which the slope is found to creep; 0 if at most 100 show no
  /// creep.
  int failures_until_creep(double way, double standing) {
    for (int i = 1; i <= 100; ++i) {
      fail(way, standing);
      if (failure.is_creep()) return i;
    }
    return 0;
  }
};

TEST(RepeatedFailure, EndsAfterElevenThatGoNowhere) {
  EXPECT_EQ(Slope().failures_until_creep(0.0, 0.0), 11);
  EXPECT_EQ(Slope().failures_until_creep(0.04 * size, 9.0), 11);
}

TEST(RepeatedFailure, IsNoneWhereSoilSlides) {
  EXPECT_EQ(Slope().failures_until_creep(0.06 * size, 0.0), 0);
}

TEST(RepeatedFailure, IsNoneWhereSoilStandsMeanwhile) {
  EXPECT_EQ(Slope().failures_until_creep(0.0, 11.0), 0);
}

TEST(RepeatedFailure, SaysWhenWhereAndHowFar) {
  Slope slope;
  slope.fail(1.0, 20.0);
  slope.failures_until_creep(0.002, 0.0);
  try {
    slope.failure.refuse_creep(slope.time, slope.position);
    FAIL() << "it creeps";
  } catch (const EquilibriumLost& error) {
    const std::string text = error.what();
    EXPECT_EQ(
        text.substr(0, text.find(". ")),
        "t = 132 s: the soil creeps and does not come to rest: since t = 121 s it has lost its "
        "equilibrium 11 times, each time as soon as it lay still, and has moved by 0.022 m at "
        "most meanwhile, at (4.022, 1) m");
  }
}

TEST(RepeatedFailure, CountsOnFromItsArchive) {
  Slope slope;
  for (int i = 0; i < 6; ++i) slope.fail(0.0, 0.0);
  StateArchive kept;
  kept(slope.failure);
  Slope resumed;
  StateArchive given(kept.finish());
  given(resumed.failure);
  given.finish();
  resumed.time = slope.time;
  EXPECT_EQ(resumed.failures_until_creep(0.0, 0.0), 5);
}

}  // namespace repeated_failure_test
}  // namespace suffuse
