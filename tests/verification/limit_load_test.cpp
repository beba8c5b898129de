/// Limit loads of strip footings on weightless soil against the values of Prandtl and Reissner.

#include <gtest/gtest.h>

#include "verification/footing.hpp"

namespace suffuse::footing {
namespace limit_load_test {

TEST(Footing, OnTrescasSoilCarriesPrandtlsLoad) {
  const double exact = exact_cohesion_factor(0.0);
  EXPECT_NEAR(limit_of_fine_meshes({.cohesion = 1.0}, exact), exact, 0.02 * exact);
}

TEST(Footing, CarriesThatUnderVonMisesLawToo) {
  const double exact = exact_cohesion_factor(0.0);
  const Footing footing{.law = "von-mises", .cohesion = 1.0};
  EXPECT_NEAR(limit_of_fine_meshes(footing, exact), exact, 0.02 * exact);
}

TEST(Footing, CarriesMoreOnTrianglesThatLock) {
  const Footing crossed{.cohesion = 1.0};
  const Footing regular{.cohesion = 1.0, .crossed = false};
  EXPECT_GE(limit_load(regular, 4), 1.05 * limit_load(crossed, 4));
}

TEST(Footing, OnSoilWithFrictionCarriesReissnersLoads) {
  const double q = exact_surcharge_factor(20.0);
  const double c = exact_cohesion_factor(20.0);
  EXPECT_NEAR(q, 6.399, 1e-3);
  EXPECT_NEAR(c, 14.835, 1e-3);
  const Footing beside{.friction = 20.0, .surcharge = 1.0, .push = 200.0};
  EXPECT_NEAR(limit_of_fine_meshes(beside, q), q, 0.04 * q);
  const Footing cohesive{.friction = 20.0, .cohesion = 1.0, .push = 200.0};
  EXPECT_NEAR(limit_of_fine_meshes(cohesive, c), c, 0.04 * c);
}

}  // namespace limit_load_test
}  // namespace suffuse::footing
