/// Limit loads that need larger meshes: footings on soil of 30 degrees.

#include <gtest/gtest.h>

#include "verification/footing.hpp"

namespace suffuse::footing {
namespace limit_load_long_test {

TEST(Footing, OnSoilOf30DegreesCarriesReissnersLoads) {
  const double q = exact_surcharge_factor(30.0);
  const double c = exact_cohesion_factor(30.0);
  EXPECT_NEAR(q, 18.401, 1e-3);
  EXPECT_NEAR(c, 30.140, 1e-3);
  const Footing beside{.friction = 30.0, .surcharge = 1.0, .push = 300.0};
  EXPECT_NEAR(limit_of_fine_meshes(beside, q), q, 0.04 * q);
  const Footing cohesive{.friction = 30.0, .cohesion = 1.0, .push = 300.0};
  EXPECT_NEAR(limit_of_fine_meshes(cohesive, c), c, 0.04 * c);
}

}  // namespace limit_load_long_test
}  // namespace suffuse::footing
