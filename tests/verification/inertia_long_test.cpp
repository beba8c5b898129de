/// Columns of dry sand that collapse, finer and taller.

#include <gtest/gtest.h>

#include <array>
#include <iostream>

#include "inertial_soil.hpp"

namespace suffuse {
namespace inertia_long_test {

double runout_of(const model::Collapse& c) {
  const model::CollapseResult result = model::collapse(c);
  std::cout << "a " << c.aspect << ", " << c.cells << " cells: run-out " << result.runout
            << ", height " << result.height << ", rests at " << result.time << " s, "
            << result.steps << " steps, " << result.iterations << " iterations a step, "
            << result.tries << " tries, volume " << result.volume
            << "; of a depth of 0.1, 0.05, 0.02: " << result.runout_of_depth(0.1) << ", "
            << result.runout_of_depth(0.05) << ", " << result.runout_of_depth(0.02) << std::endl;
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
