/// Soil that loses its equilibrium again and again without moving far.

#include "coupling/repeated_failure.hpp"

#include <gtest/gtest.h>

#include "results/state_archive.hpp"

namespace suffuse {
namespace repeated_failure_test {

constexpr double size = 0.5;  // of elements, m

/// Two points; the second one moves by `way` after each failure. Returns the share after the last.
double share_after(int failures, double way, RepeatedFailure<2>& failure) {
  std::vector<Vector<2>> position{{0.0, 0.0}, {3.0, 1.0}};
  for (int k = 0; k < failures; ++k) {
    failure.fails(position, size);
    position[1][0] += way;
  }
  return failure.held_share();
}
double share_after(int failures, double way) {
  RepeatedFailure<2> failure;
  return share_after(failures, way, failure);
}

TEST(RepeatedFailure, DoublesTheShareWhereItGoesNowhere) {
  for (const double way : {0.0, 0.04 * size}) {
    EXPECT_DOUBLE_EQ(share_after(1, way), 0.01);
    EXPECT_DOUBLE_EQ(share_after(2, way), 0.02);
    EXPECT_DOUBLE_EQ(share_after(7, way), 0.64);
    EXPECT_EQ(share_after(20, way), 1.0);
  }
}

TEST(RepeatedFailure, IsTheFirstWhereSoilSlides) {
  EXPECT_DOUBLE_EQ(share_after(20, 0.06 * size), 0.01);
}

TEST(RepeatedFailure, CountsOnFromItsArchive) {
  RepeatedFailure<2> failure;
  share_after(3, 0.0, failure);
  StateArchive kept;
  kept(failure);
  RepeatedFailure<2> resumed;
  StateArchive given(kept.finish());
  given(resumed);
  given.finish();
  EXPECT_DOUBLE_EQ(share_after(2, 0.0, resumed), 0.16);
}

}  // namespace repeated_failure_test
}  // namespace suffuse
