#include "figures/field_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drawing/color_map.hpp"
#include "drawing/ticks.hpp"

namespace suffuse {
namespace field_scale_test {

/// 0, 1, ..., 999, one each.
std::vector<WeightedValue> thousand() {
  std::vector<WeightedValue> values;
  for (int k = 0; k < 1000; ++k) values.push_back({double(k), 1.0});
  return values;
}

TEST(FieldScale, ReachesFromTheLeastToTheLargest) {
  const FieldScale scale = value_scale(thousand(), {});
  EXPECT_EQ(scale.range, (std::array<double, 2>{0.0, 999.0}));
  EXPECT_FALSE(scale.exceeds_low || scale.exceeds_high || scale.uniform);
  EXPECT_TRUE(scale.notes.empty());
  EXPECT_EQ(scale.color(999.0), viridis(1.0));
  EXPECT_EQ(scale.color(std::nan("")), no_value);
}

TEST(FieldScale, LeavesOutAFewValuesThatAreFarOutside) {
  auto values = thousand();
  values.push_back({1e5, 5.0});
  FieldScale scale = value_scale(values, {});
  EXPECT_NEAR(scale.range[1], 994.0, 2.0);
  EXPECT_EQ(scale.range[0], 0.0);
  EXPECT_TRUE(scale.exceeds_high);
  EXPECT_FALSE(scale.exceeds_low);
  EXPECT_EQ(scale.notes, (std::vector<std::string>{"99 % of the area", "largest 100000"}));
  values.push_back({-1e5, 5.0});
  scale = value_scale(values, {.shares = "points"});
  EXPECT_EQ(scale.notes,
            (std::vector<std::string>{"98 % of the points", "least -100000", "largest 100000"}));
  // Weights count, not numbers: with twenty in a thousand the value is kept.
  values = thousand();
  values.push_back({1e5, 20.0});
  scale = value_scale(values, {});
  EXPECT_EQ(scale.range[1], 1e5);
  EXPECT_TRUE(scale.notes.empty());
}

TEST(FieldScale, OfTheUserIsKept) {
  const FieldScale scale = value_scale(thousand(), {.range = {{10.0, 2000.0}}});
  EXPECT_EQ(scale.range, (std::array<double, 2>{10.0, 2000.0}));
  EXPECT_TRUE(scale.exceeds_low);
  EXPECT_FALSE(scale.exceeds_high);
}

// A safety is infinite where no water rises.
TEST(FieldScale, TakesInfiniteValuesForLargeOnes) {
  auto values = thousand();
  values.push_back({HUGE_VAL, 500.0});
  const FieldScale scale = value_scale(values, {});
  EXPECT_EQ(scale.range[1], 999.0);
  EXPECT_TRUE(scale.exceeds_high);
  EXPECT_EQ(scale.color(HUGE_VAL), viridis(1.0));
  EXPECT_TRUE(value_scale(values, {.range = {{0.0, 5.0}}}).exceeds_high);
}

TEST(FieldScale, OfRoundOffIsOneColour) {
  FieldScale scale = value_scale({{0.3, 1.0}, {0.3 + 1e-13, 1.0}}, {});
  EXPECT_TRUE(scale.uniform);
  EXPECT_EQ(scale.color(0.3), scale.color(0.3 + 1e-13));
  EXPECT_TRUE(scale.levels().empty());
  // Near zero, only the round-off of the request tells whether values agree.
  scale = value_scale({{-1e-17, 1.0}, {3e-17, 1.0}}, {.round_off = 1e-15});
  EXPECT_TRUE(scale.uniform);
  EXPECT_EQ(scale.range[0], 0.0);
  EXPECT_FALSE(value_scale({{-1e-14, 1.0}, {3e-14, 1.0}}, {.round_off = 1e-15}).uniform);
}

TEST(FieldScale, ByTheLogarithmLeavesOutWhatIsNotAboveZero) {
  const FieldScale scale = value_scale(
      {{-1.0, 1.0}, {0.0, 1.0}, {1e-4, 1.0}, {1e-2, 1.0}, {1.0, 1.0}}, {.logarithmic = true});
  EXPECT_EQ(scale.range, (std::array<double, 2>{1e-4, 1.0}));
  EXPECT_NEAR(scale.fraction(1e-2), 0.5, 1e-12);
  EXPECT_EQ(scale.color(0.0), no_value);
  EXPECT_EQ(scale.notes, (std::vector<std::string>{"grey: not above zero"}));
  ASSERT_EQ(scale.levels().size(), 5U);
  EXPECT_NEAR(scale.levels()[1], 1e-3, 1e-15);
}

TEST(Ticks, AreWrittenAsByHand) {
  EXPECT_EQ(digits_text(0.5, 4), "0.5");
  EXPECT_EQ(digits_text(0.0, 4), "0");
  EXPECT_EQ(digits_text(88681.2, 4), "88681");
  EXPECT_EQ(digits_text(1.23456e-5, 4), "1.235e-5");
  EXPECT_EQ(digits_text(-3e-5, 4), "-3e-5");
  EXPECT_EQ(digits_text(2.5e7, 4), "2.5e7");
  EXPECT_EQ(digits_text(9.81234, 4), "9.812");
  EXPECT_EQ(tick_text(20000.0), "20000");
  EXPECT_EQ(tick_text(0.001), "0.001");
  EXPECT_EQ(tick_text(518400.0), "518400");
}

// The ends have the digits that tell them from the ticks between them.
TEST(FieldScale, LabelsOfNearlyConstantValuesDiffer) {
  for (const double spread : {1e-2, 4e-6, 4e-8}) {
    const double low = 4.01088e-14;
    const double high = low * (1.0 + spread);
    const FieldScale scale = value_scale({{low, 1.0}, {high, 1.0}}, {});
    const std::vector<BarMark> marks = bar_of(scale, "").marks;
    ASSERT_GE(marks.size(), 5U);
    for (const BarMark& mark : marks) {
      const double place = low + mark.share * (high - low);
      EXPECT_NEAR(std::stod(mark.text), place, 0.01 * (high - low)) << mark.text;
    }
  }
}

}  // namespace field_scale_test
}  // namespace suffuse
