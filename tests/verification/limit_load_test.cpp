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

/// Such triangles lock unless elements share their dilatation: on triangles in rows 4 cells carried
/// 7.19, on free ones 7.30.
TEST(Footing, CarriesThatOnTrianglesInRowsAndOnFreeOnesToo) {
  const double exact = exact_cohesion_factor(0.0);
  const double crossed = limit_load({.cohesion = 1.0}, 4);
  for (const Triangles triangles : {Triangles::in_rows, Triangles::free}) {
    const Footing footing{.cohesion = 1.0, .triangles = triangles};
    EXPECT_NEAR(limit_of_fine_meshes(footing, exact), exact, 0.03 * exact);
    EXPECT_LE(limit_load(footing, 4), 1.02 * crossed);
  }
}

/// Soil that dilates in full is stiffer in pairs of triangles than in crossed ones of the same
/// size, of which there are 1.7 times as many.
TEST(Footing, OnFreeTrianglesAndSoilWithFrictionCarriesLittleMore) {
  const auto compare = [](Footing footing) {
    const double crossed = limit_load(footing, 4);
    footing.triangles = Triangles::free;
    const double coarse = limit_load(footing, 2);
    const double fine = limit_load(footing, 4);
    EXPECT_LT(fine, coarse);
    EXPECT_NEAR(fine, crossed, 0.08 * crossed);
  };
  compare({.friction = 20.0, .surcharge = 1.0, .push = 200.0});
  compare({.friction = 20.0, .cohesion = 1.0, .push = 200.0});
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
