#include "physics/drag.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference_table.hpp"

namespace suffuse {
namespace drag_test {

ConductivityModel model(const char* law) {
  return {conductivity_law(law), 2e-2, 0.6};
}

/// Under a constant head the flux is proportional to the conductivity.
TEST(Conductivity, FollowsKozenyCarmanAsInTheReferenceTable) {
  const auto rows = read_reference("permeability-feedback.csv");
  ASSERT_GT(rows.size(), 20U);
  double largest = 0.0;
  for (const auto& row : rows) {
    const double expected = row.number("q") / row.number("q0");
    const double k = model("kozeny-carman").at(0.3, row.number("n_L")) / 2e-2;
    EXPECT_NEAR(k, expected, 1e-12 * expected) << row.number("n_L");
    largest = std::max(largest, k);
  }
  EXPECT_GT(largest, 3.0);  // the table covers large changes
}

TEST(Conductivity, StaysWhereTheLawIsConstant) {
  EXPECT_EQ(model("constant").at(0.3, 0.4), 2e-2);
}

TEST(Conductivity, IsTheGivenOneAtTheInitialPorosity) {
  for (const double n : {0.1, 0.3, 0.37, 0.9}) {
    EXPECT_EQ(model("kozeny-carman").at(n, n), 2e-2) << n;
  }
}

/// Ergun's linear term is that of Kozeny and Carman for the same grains: kappa = d^2 KC(n) / 150.
TEST(Conductivity, AgreesWithErgunsGrains) {
  const double n_0 = 0.3;
  const double n = 0.37;
  const double d = ergun_grain_size(2e-2, n_0, 1000.0, 1e-3);
  const double permeability = d * d * n * n * n / ((1.0 - n) * (1.0 - n)) / 150.0;
  EXPECT_NEAR(model("kozeny-carman").at(n_0, n), permeability * 1000.0 * 9.81 / 1e-3, 1e-15);
}

}  // namespace drag_test
}  // namespace suffuse
