/// Columns of dry sand that collapse, finer and taller.

#include <gtest/gtest.h>

#include <iostream>

#include "inertial_soil.hpp"

namespace suffuse {
namespace inertia_long_test {

double runout_of(const model::Collapse& c) {
  const model::CollapseResult result = model::collapse(c);
  std::cout << "a " << c.aspect << ", " << c.cells << " cells: run-out " << result.runout
            << ", height " << result.height << ", rests at " << result.time << " s, "
            << result.steps << " steps, " << result.iterations << " iterations a step, "
            << result.tries << " tries, volume " << result.volume << std::endl;
  EXPECT_TRUE(result.rests);
  return result.runout;
}

// Lube and others (2005): 1.2 a below 1.8, 1.9 a^(2/3) above 2.8.

TEST(CollapseLong, OfALowColumnIsThatOfSandOnFinerMeshes) {
  for (const int cells : {16, 32}) EXPECT_NEAR(runout_of({.cells = cells}), 1.2, 0.2 * 1.2);
}

TEST(CollapseLong, OfATallColumnIsThatOfSand) {
  const double exact = 1.9 * std::pow(3.0, 2.0 / 3.0);
  for (const int cells : {8, 16}) {
    EXPECT_NEAR(runout_of({.aspect = 3.0, .cells = cells, .reach = 8.0}), exact, 0.2 * exact);
  }
}

}  // namespace inertia_long_test
}  // namespace suffuse
