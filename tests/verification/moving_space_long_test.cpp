/// A bank of fine tetrahedra fails as that of fine triangles does.

#include <gtest/gtest.h>

#include <iostream>

#include "moving_space.hpp"

namespace suffuse {
namespace moving_space_long_test {

/// In the plane, elements of 0.125 m fail at 7.22 and 7.51 s in rows, as their diagonals run, and
/// at 7.24 s crossed, and have moved by 1.15, 0.93 and 0.90 m at 11 s.
TEST(SpaceBank, OfFinerTetrahedraFailsAndRunsOutAsInThePlane) {
  model::SpaceRun run = model::slab_of_bank(1, 8);
  run.run_to(11.0);
  const HistoryRow now = run.history();
  std::cout << "failed at " << now.failure_time << " s, moved by " << now.displacement_max
            << " m at 11 s, " << run.model().steps() << " steps\n";
  EXPECT_NEAR(now.failure_time, 7.23, 0.15);
  EXPECT_NEAR(now.displacement_max, 0.95, 0.15);
  EXPECT_LT(run.worst_residual(), 1e-12);
}

}  // namespace moving_space_long_test
}  // namespace suffuse
