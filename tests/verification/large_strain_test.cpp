/// Consolidation at large strain of soil whose pores close at its surface.

#include "large_strain.hpp"

namespace suffuse {
namespace large_strain_test {

/// Points that cross elements disturb the pressure for the time in which little water leaves.
TEST(LargeStrain, ReachesItsEndThoughPoresCloseAtTheSurface) {
  const model::Deviation off = model::deviation_at_large_strain("kozeny-carman", 32, 0.4);
  EXPECT_LT(off.settlement, 0.0015);
  EXPECT_LT(off.pressure, 0.015);
}

}  // namespace large_strain_test
}  // namespace suffuse
