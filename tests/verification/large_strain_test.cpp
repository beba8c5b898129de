/// Consolidation at large strain on finer meshes, and of soil whose pores close at its surface.

#include "large_strain.hpp"

namespace suffuse {
namespace large_strain_test {

TEST(LargeStrain, TendsToTheExactSolution) {
  const model::Deviation coarse = model::deviation_at_large_strain("constant", 32, 0.05);
  const model::Deviation fine = model::deviation_at_large_strain("constant", 128, 0.05);
  EXPECT_LT(fine.settlement, 0.003);
  EXPECT_LT(fine.pressure, 0.003);
  EXPECT_GT(std::log2(coarse.settlement / fine.settlement) / 2.0, 0.6);
  EXPECT_GT(std::log2(coarse.pressure / fine.pressure) / 2.0, 1.0);
}

/// Points that cross elements disturb the pressure for the time in which little water leaves.
TEST(LargeStrain, ReachesItsEndThoughPoresCloseAtTheSurface) {
  const model::Deviation off = model::deviation_at_large_strain("kozeny-carman", 32, 0.4);
  EXPECT_LT(off.settlement, 0.01);
  EXPECT_LT(off.pressure, 0.03);
}

}  // namespace large_strain_test
}  // namespace suffuse
