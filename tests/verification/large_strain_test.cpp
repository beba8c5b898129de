/// Consolidation at large strain of soil whose pores close at its surface.

#include "large_strain.hpp"

namespace suffuse {
namespace large_strain_test {

/// Points that cross elements disturb the pressure for the time in which little water leaves.
TEST(LargeStrain, ReachesItsEndThoughPoresCloseAtTheSurface) {
  const model::Deviation coarse = model::deviation_at_large_strain("kozeny-carman", 16, 0.4);
  const model::Deviation fine = model::deviation_at_large_strain("kozeny-carman", 64, 0.4);
  EXPECT_LT(coarse.pressure, 0.01);
  EXPECT_LT(fine.surface, 0.001);
  EXPECT_LT(fine.pressure, 0.004);
  EXPECT_GT(std::log2(coarse.surface / fine.surface) / 2.0, 0.8);
  EXPECT_GT(std::log2(coarse.pressure / fine.pressure) / 2.0, 0.5);
}

/// Motion changes resistances in each step, which does not shorten it.
TEST(LargeStrain, TakesLittleMoreStepsWherePoresClose) {
  const model::Deviation closes = model::deviation_at_large_strain("kozeny-carman", 16, 0.4);
  const model::Deviation constant = model::deviation_at_large_strain("constant", 16, 0.4);
  EXPECT_LT(closes.steps, 1.5 * static_cast<double>(constant.steps));
}

}  // namespace large_strain_test
}  // namespace suffuse
