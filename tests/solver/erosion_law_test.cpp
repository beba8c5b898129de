#include "physics/erosion_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference_table.hpp"

namespace suffuse {
namespace {

constexpr double n_0 = 0.3;
constexpr double n_max = 0.4;

ErosionModel model(ErosionLaw law, double rate) {
  return {law, rate, 2.0, n_max};
}

/// Porosity after many unequal steps.
double stepped(const ErosionModel& m, double end, int steps) {
  double n = n_0;
  double t = 0.0;
  for (int s = 1; s <= steps; ++s) {
    const double next = end * s * s / (static_cast<double>(steps) * steps);
    n = porosity_after(m, n, t, next, unset);
    t = next;
  }
  return n;
}

TEST(ErosionLaw, FollowsTheReferenceTable) {
  const auto rows = read_reference("porosity.csv");
  ASSERT_GT(rows.size(), 20u);
  for (const auto& row : rows) {
    const double t = row.number("t");
    EXPECT_NEAR(porosity_after(model(ErosionLaw::constant, 1e-3), n_0, 0.0, t, unset),
                row.number("n_const_alpha1e-3"), 1e-13);
    EXPECT_NEAR(porosity_after(model(ErosionLaw::constant, 5e-3), n_0, 0.0, t, unset),
                row.number("n_const_alpha5e-3"), 1e-13);
    EXPECT_NEAR(porosity_after(model(ErosionLaw::logarithmic, 1e-2), n_0, 0.0, t, unset),
                row.number("n_log_beta1e-2"), 5e-13);
  }
}

TEST(ErosionLaw, FirstOrderDecaysExponentially) {
  const ErosionModel m = model(ErosionLaw::first_order, 0.05);
  EXPECT_NEAR(porosity_after(m, n_0, 0.0, 42.0, unset), n_max - 0.1 * std::exp(-0.05 * 40.0),
              1e-15);
}

TEST(ErosionLaw, DoesNotDependOnTheSteps) {
  for (const ErosionLaw law :
       {ErosionLaw::constant, ErosionLaw::logarithmic, ErosionLaw::first_order}) {
    const ErosionModel m = model(law, 7e-3);
    const double once = porosity_after(m, n_0, 0.0, 60.0, unset);
    for (const int steps : {2, 7, 100, 1000}) EXPECT_NEAR(stepped(m, 60.0, steps), once, 1e-12);
  }
}

TEST(ErosionLaw, StartsAndEndsAtItsExactTimes) {
  const ErosionModel m = model(ErosionLaw::constant, 1e-3);
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 2.0, unset), n_0);
  EXPECT_GT(porosity_after(m, n_0, 0.0, 2.0 + 1e-9, unset), n_0);
  // 0.1 / 1e-3 = 100 s after the start.
  EXPECT_LT(porosity_after(m, n_0, 0.0, 102.0 - 1e-9, unset), n_max);
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 102.0 + 1e-9, unset), n_max);
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 1e6, unset), n_max);
  EXPECT_EQ(erosion_rate(m, n_max, 200.0, unset), 0.0);
  EXPECT_EQ(erosion_rate(m, n_0, 1.999, unset), 0.0);
  EXPECT_EQ(erosion_rate(m, n_0, 2.0, unset), 1e-3);
}

TEST(ErosionLaw, LogarithmicLawApproachesItsCapWithoutPassingIt) {
  const ErosionModel m = model(ErosionLaw::logarithmic, 1e-2);
  double before = n_0;
  for (double t = 10.0; t < 2000.0; t += 10.0) {
    const double n = porosity_after(m, before, t - 10.0, t, unset);
    EXPECT_GE(n, before);
    EXPECT_LE(n, n_max);
    before = n;
  }
  EXPECT_NEAR(n_max - before, 0.0, 1e-15);
  // One step of a day.
  EXPECT_EQ(porosity_after(m, n_0, 0.0, 86400.0, unset), n_max);
}

TEST(ErosionLaw, RateIsTheSlopeOfPorosity) {
  for (const ErosionLaw law :
       {ErosionLaw::constant, ErosionLaw::logarithmic, ErosionLaw::first_order}) {
    const ErosionModel m = model(law, 8e-3);
    const double h = 1e-3;
    const double n = porosity_after(m, n_0, 0.0, 9.0, unset);
    const double slope = (porosity_after(m, n_0, 0.0, 9.0 + h, unset) -
                          porosity_after(m, n_0, 0.0, 9.0 - h, unset)) /
                         (2.0 * h);
    EXPECT_NEAR(erosion_rate(m, n, 9.0, unset), slope, 1e-9);
  }
}

}  // namespace
}  // namespace suffuse
