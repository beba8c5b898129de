/// Columns of dry sand that collapse, finer and taller.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <vector>

#include "inertial_soil.hpp"

namespace suffuse {
namespace inertia_long_test {

model::CollapseResult collapse(const model::Collapse& c) {
  model::CollapseResult result = model::collapse(c);
  std::cout << "a " << c.aspect << ", " << c.cells << " cells: run-out " << result.runout
            << ", height " << result.height << ", rests at " << result.time << " s, "
            << result.steps << " steps, " << result.iterations << " iterations a step, "
            << result.tries << " tries, volume " << result.volume << "; run-out of a depth of a "
            << "tenth of the height " << result.runout_of_depth(0.1 * c.aspect) << std::endl;
  EXPECT_TRUE(result.rests);
  return result;
}

// Lube and others (2005): 1.2 a below 1.8, 1.9 a^(2/3) above 2.8.

/// The front of 98 % of the sand gets thinner and reaches farther with each refinement, in other
/// codes too. Where the sand is a tenth of the column's height deep, run-out converges. With
/// another tolerance of Newton's method it differs by up to 1 %.
TEST(CollapseLong, OfALowColumnIsThatOfSandOnFinerMeshes) {
  for (const double aspect : {0.5, 1.0}) {
    std::vector<double> deep;
    for (const int cells : {8, 16, 32}) {
      const model::CollapseResult sand = collapse({.aspect = aspect, .cells = cells});
      if (cells > 8) {
        EXPECT_NEAR(sand.runout, 1.2 * aspect, 0.2 * 1.2 * aspect);
      }
      deep.push_back(sand.runout_of_depth(0.1 * aspect));
    }
    EXPECT_NEAR(deep[1], 1.2 * aspect, 0.08 * 1.2 * aspect);
    EXPECT_NEAR(deep[2], 1.2 * aspect, 0.03 * 1.2 * aspect);
    // 0.33 and 0.23 are found.
    EXPECT_LT(std::abs(deep[2] - deep[1]), 0.6 * std::abs(deep[1] - deep[0]));
  }
}

/// The friction grows from 31 to 41 degrees with the rate of shear and the size of the grains. Then
/// the run-out converges as the mesh comes to resolve that size.
TEST(CollapseLong, OfSandWhoseFrictionGrowsWithItsRateConverges) {
  std::vector<double> runout;
  for (const int cells : {8, 16, 32}) {
    runout.push_back(
        collapse({.aspect = 1.0, .cells = cells, .friction = {.fast = 41.0, .grain_size = 0.005}})
            .runout);
  }
  // 0.51 is found; without growth 0.64.
  EXPECT_LT(runout[2] - runout[1], 0.55 * (runout[1] - runout[0]));
  EXPECT_NEAR(runout[2], 1.2, 0.1 * 1.2);
}

TEST(CollapseLong, OfATallColumnIsThatOfSand) {
  const double exact = 1.9 * std::pow(3.0, 2.0 / 3.0);
  for (const int cells : {8, 16}) {
    EXPECT_NEAR(collapse({.aspect = 3.0, .cells = cells, .reach = 8.0}).runout, exact, 0.2 * exact);
  }
}

/// The column of aluminium bars of Bui and others (2008), doi 10.1002/nag.688: 0.2 m wide and 0.1 m
/// high against a wall, friction 19.8 degrees, K 0.7 MPa, nu 0.3, 2650 kg/m3. The depth of the soil
/// at rest is that of the bars within 5 mm.
TEST(CollapseLong, OfAluminiumBarsHasTheirSurface) {
  constexpr double width = 0.2;
  constexpr double height = 0.1;
  constexpr double bulk_modulus = 0.7e6;
  constexpr double young = 3.0 * (1.0 - 2.0 * 0.3) * bulk_modulus;
  constexpr std::array at{0.1, 0.2, 0.3, 0.4};                    // m from the wall
  constexpr std::array measured{0.0776, 0.0474, 0.0221, 0.0042};  // m
  for (const int rows : {8, 16}) {
    const double h = height / rows;
    model::InertialModel m(model::crossed_mesh(6 * rows, rows + 2, 6 * height, height + 2 * h),
                           model::frictional_soil(young, 19.8), 2650.0, {0.0, -9.81},
                           [&](const Vector<2>& x) { return x[0] < width && x[1] < height; });
    m.support("left", Support::normal);
    m.support("right", Support::normal);
    m.support("bottom", Support::both);
    m.start_motion();
    bool rests = false;
    while (m.time < 3.0 && !rests) {
      const model::InertialStep step = m.move(0.005);
      rests =
          m.time > 0.2 && SoilKinetics{m.energy(), step.inertia_share, m.extent(height)}.is_rest();
    }
    EXPECT_TRUE(rests);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double strip = 2.0 * h;
      double volume = 0.0;
      for (int p = 0; p < m.points.size(); ++p) {
        if (std::abs(m.points.position[p][0] - at[i]) < 0.5 * strip) volume += m.points.volume[p];
      }
      EXPECT_NEAR(volume / strip, measured[i], 0.005) << rows << " rows, at " << at[i] << " m";
    }
    double toe = 0.0;
    for (const Vector<2>& place : m.points.position) toe = std::max(toe, place[0]);
    std::cout << rows << " rows: toe at " << toe << " m, rests at " << m.time << " s\n";
  }
}

}  // namespace inertia_long_test
}  // namespace suffuse
