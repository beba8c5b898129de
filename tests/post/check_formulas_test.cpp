/// The formulas behind `suffuse-post check`, against published numbers and a second method.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "checks/blanket_theory.hpp"
#include "checks/eurocode.hpp"
#include "checks/filter_criteria.hpp"
#include "checks/sellmeijer.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace check_formulas_test {

/// Bond and Harris, Decoding Eurocode 7: 54.8 against 56.2 kPa, 12.4 against 27.9 kN. A column of
/// 3.2 m whose soil weighs 19.5 kN/m3, under an excess head of 0.9363 m at its base.
TEST(Eurocode, HeaveIsThatOfTheWorkedExample) {
  const double water = 9810.0;
  const double depth = 3.2;
  const double excess = 0.9363 * water;
  const ColumnLoads column{.depth = depth,
                           .pressure = depth * water + excess,
                           .total_stress = depth * 19.5e3,
                           .seepage_force = excess,
                           .weight = depth * (19.5e3 - water)};
  const PartialFactors factors = CheckSettings{}.heave;
  const Utilisation stresses = heave_by_stresses(column, factors);
  EXPECT_NEAR(stresses.effect, 54.8e3, 50.0);
  EXPECT_NEAR(stresses.resistance, 56.2e3, 50.0);
  const Utilisation forces = heave_by_forces(column, factors);
  EXPECT_NEAR(forces.effect, 12.4e3, 50.0);
  EXPECT_NEAR(forces.resistance, 27.9e3, 50.0);
  EXPECT_NEAR(forces.factor(), 27.9 / 12.4, 5e-3);
}

TEST(Eurocode, NothingActsInStillWater) {
  const ColumnLoads column{.depth = 1.0, .pressure = 9.81e3, .total_stress = 2e4, .weight = 1e4};
  EXPECT_TRUE(std::isinf(heave_by_forces(column, {1.35, 0.9}).factor()));
  EXPECT_NEAR(uplift(column, {1.0, 0.9}).factor(), 0.9 * 2e4 / 9.81e3, 1e-12);
}

PipingLayer grid_layer(double thickness, double length) {
  return {.length = length,
          .thickness = thickness,
          .d70 = 1e-4,
          .permeability = 1.157e-12,
          .grain_size_correction = false};
}

/// The public grid of 36 cases. Where D = L it takes 0.91 for F_G, although F_G tends to 0.91 e^0.1
/// there. Its heads are rounded to a centimetre.
TEST(Sellmeijer, CriticalHeadsAreThoseOfThePublicGrid) {
  const std::vector<ReferenceRow> grid = read_reference("sellmeijer_grid.csv");
  ASSERT_EQ(grid.size(), 36u);
  for (const ReferenceRow& row : grid) {
    PipingLayer layer = grid_layer(row.number("thickness"), row.number("length"));
    layer.d70 = row.number("d70");
    layer.permeability = row.number("permeability");
    const double limit = layer.thickness == layer.length ? std::exp(0.1) : 1.0;
    const double head = limit * row.number("head");
    EXPECT_NEAR(critical_head(layer), head, 0.01 * head)
        << "D " << layer.thickness << ", L " << layer.length << ", d70 " << layer.d70;
  }
}

/// L F_R F_S F_G by hand: 30 x 0.31085 x 0.30655 x 1.2023, times (2.08)^0.6 = 1.5518.
TEST(Sellmeijer, IsTheProductOfItsFactors) {
  PipingLayer layer = grid_layer(10.0, 30.0);
  EXPECT_NEAR(critical_head(layer), 30.0 * 0.310841 * 0.306549 * 1.202361, 1e-3);
  layer.grain_size_correction = true;
  EXPECT_NEAR(critical_head(layer) / critical_head(grid_layer(10.0, 30.0)), 1.551808, 1e-6);
  layer.uniformity = 2.0 * 1.81;
  layer.roundness = 2.0 * 49.8;
  layer.relative_density = 2.0 * 72.5;
  const double together = std::exp2(0.35 + 0.13 - 0.02) * 1.551808;
  EXPECT_NEAR(critical_head(layer) / critical_head(grid_layer(10.0, 30.0)), together, 1e-5);
}

/// The exponent of F_G has no bound at D = L; the factor has.
TEST(Sellmeijer, IsContinuousWhereTheLayerIsAsThickAsLong) {
  const double at = critical_head(grid_layer(30.0, 30.0));
  EXPECT_NEAR(critical_head(grid_layer(30.0 * (1.0 - 1e-6), 30.0)), at, 1e-5 * at);
  EXPECT_NEAR(critical_head(grid_layer(30.0 * (1.0 + 1e-6), 30.0)), at, 1e-5 * at);
}

TEST(Sellmeijer, SaysWhatLiesOutsideTheTests) {
  PipingLayer layer = grid_layer(10.0, 30.0);
  EXPECT_EQ(outside_tests(layer),
            (std::vector<std::string>{"d70 = 0.1 mm; the tests had 0.15 to 0.43 mm"}));
  layer.d70 = 0.43e-3;
  layer.roundness = 71.0;
  EXPECT_EQ(outside_tests(layer),
            (std::vector<std::string>{"KAS = 71 %; the tests had 35 to 70 %"}));
}

/// A base with `fines` % below 0.075 mm and these sizes at 85, 90 and 95 %.
Gradation base(double fines, double d85, double d90, double d95) {
  return Gradation(
      {{0.001, 0.0}, {0.075, fines}, {d85, 85.0}, {d90, 90.0}, {d95, 95.0}, {4.75, 100.0}});
}

TEST(Filters, BoundariesAreThoseOfTheFourGroups) {
  const ErosionBoundaries clay = *erosion_boundaries(
      Gradation({{0.001, 0.0}, {0.06, 85.0}, {0.075, 90.0}, {0.2, 95.0}, {1.0, 100.0}}));
  EXPECT_NEAR(clay.none, 9.0 * 0.06, 1e-12);
  EXPECT_NEAR(*clay.excessive, 9.0 * 0.2, 1e-12);
  EXPECT_NEAR(clay.continuing, 9.0 * 0.2, 1e-12);

  const ErosionBoundaries silty = *erosion_boundaries(base(50.0, 0.5, 0.8, 1.5));
  EXPECT_NEAR(silty.none, 0.7, 1e-12);
  EXPECT_NEAR(*silty.excessive, 9.0 * 0.8, 1e-12);
  EXPECT_NEAR(silty.continuing, 9.0 * 1.5, 1e-12);
  EXPECT_FALSE(erosion_boundaries(base(50.0, 0.5, 1.0, 3.0))->excessive);

  const double design = (35.0 - 25.0) / 20.0 * (4.0 * 1.0 - 0.7) + 0.7;
  const ErosionBoundaries mixed = *erosion_boundaries(base(25.0, 1.0, 2.0, 3.0));
  EXPECT_NEAR(mixed.none, 1.6 * design, 1e-12);
  EXPECT_NEAR(*mixed.excessive, 2.5 * design, 1e-12);

  const ErosionBoundaries sand = *erosion_boundaries(base(5.0, 1.0, 2.0, 3.0));
  EXPECT_NEAR(sand.none, 7.0, 1e-12);
  EXPECT_NEAR(*sand.excessive, 9.0, 1e-12);
  EXPECT_NEAR(sand.continuing, 27.0, 1e-12);
}

/// Half of this soil is gravel; without it 60 % of its grains are fines, not 30 %.
TEST(Filters, LeaveGravelOutOfTheBase) {
  const Gradation moraine({{0.001, 0.0}, {0.075, 30.0}, {4.75, 50.0}, {50.0, 100.0}});
  EXPECT_NEAR(erosion_boundaries(moraine)->none, 0.7, 1e-12);
}

/// Between 0 and 40 % of this base are fines: its group is not known.
TEST(Filters, UnknownFinesAreNotNone) {
  EXPECT_FALSE(erosion_boundaries(Gradation({{0.1, 40.0}, {1.0, 85.0}, {2.0, 100.0}})));
  EXPECT_FALSE(erosion_boundaries(Gradation({{0.05, 90.0}, {2.0, 100.0}})));
  EXPECT_TRUE(erosion_boundaries(Gradation({{0.05, 30.0}, {1.0, 85.0}, {2.0, 100.0}})));
  EXPECT_TRUE(erosion_boundaries(Gradation({{0.1, 0.0}, {1.0, 85.0}, {2.0, 100.0}})));
}

TEST(Filters, TerzaghiComparesSizes) {
  const Gradation fine({{0.01, 0.0}, {0.1, 15.0}, {1.0, 85.0}, {2.0, 100.0}});
  const Gradation coarse({{0.5, 0.0}, {3.0, 15.0}, {20.0, 100.0}});
  EXPECT_NEAR(*retention_ratio(fine, coarse), 3.0, 1e-12);
  EXPECT_NEAR(*drainage_ratio(fine, coarse), 30.0, 1e-12);
  const Gradation begins_late({{0.5, 20.0}, {20.0, 100.0}});
  EXPECT_FALSE(retention_ratio(fine, begins_late));
}

/// Head in the aquifer by finite differences: h'' = c^2 h where there is a cover, h'' = 0 below the
/// levee; the covers end open or closed. Cells of equal length.
double toe_share_by_differences(const BlanketSection& section, int cells) {
  const double length = section.riverside.length + section.base + section.landside.length;
  const double dx = length / cells;
  const double toe = section.riverside.length + section.base;
  // Thomas' algorithm for -h'' + c^2 (h - outside) = 0 at the middles of the cells.
  std::vector<double> upper(cells);
  std::vector<double> right(cells);
  for (int i = 0; i < cells; ++i) {
    const double x = (i + 0.5) * dx;
    const bool on_river = x < section.riverside.length;
    const bool on_land = x > toe;
    const BlanketSide& side = on_river ? section.riverside : section.landside;
    const double leak =
        on_river || on_land
            ? side.cover_conductivity /
                  (side.cover_thickness * section.aquifer_conductivity * section.aquifer_thickness)
            : 0.0;
    double diagonal = leak * dx * dx;
    double load = on_river ? leak * dx * dx : 0.0;
    const double lower = i > 0 ? 1.0 : 0.0;
    const double next = i + 1 < cells ? 1.0 : 0.0;
    diagonal += lower + next;
    // An open end is half a cell away.
    if (i == 0 && section.riverside.end == AquiferEnd::open) {
      diagonal += 2.0;
      load += 2.0;
    }
    if (i + 1 == cells && section.landside.end == AquiferEnd::open) diagonal += 2.0;
    const double pivot = diagonal - (i > 0 ? upper[i - 1] : 0.0) * lower;
    upper[i] = next / pivot;
    right[i] = (load + (i > 0 ? right[i - 1] : 0.0) * lower) / pivot;
  }
  for (int i = cells - 2; i >= 0; --i) right[i] += upper[i] * right[i + 1];
  const auto at_toe = static_cast<int>(std::lround(toe / dx));
  return 0.5 * (right[at_toe - 1] + right[at_toe]);
}

TEST(BlanketTheory, IsTheFlowInAnAquiferUnderLeakingCovers) {
  for (const AquiferEnd river : {AquiferEnd::open, AquiferEnd::closed}) {
    for (const AquiferEnd land : {AquiferEnd::open, AquiferEnd::closed}) {
      const BlanketSection section{.base = 40.0,
                                   .aquifer_thickness = 10.0,
                                   .aquifer_conductivity = 1e-4,
                                   .riverside = {60.0, 2.0, 2e-6, river},
                                   .landside = {100.0, 3.0, 1e-6, land}};
      const double exact = toe_share(section);
      const double coarse = std::abs(toe_share_by_differences(section, 500) - exact);
      const double fine = std::abs(toe_share_by_differences(section, 1000) - exact);
      EXPECT_LT(fine, 1e-5);
      EXPECT_NEAR(coarse / fine, 4.0, 0.4);
    }
  }
}

TEST(BlanketTheory, OpenGroundResistsAsAFragment) {
  BlanketSection section{.base = 20.0, .aquifer_thickness = 10.0, .aquifer_conductivity = 1e-4};
  EXPECT_DOUBLE_EQ(effective_length(section, section.riverside), 4.3);
  EXPECT_EQ(toe_share(section), 0.0);
  section.landside = {1e4, 2.0, 1e-6, AquiferEnd::infinite};
  const double x3 = std::sqrt(1e-4 * 10.0 * 2.0 / 1e-6);
  EXPECT_NEAR(toe_share(section), x3 / (4.3 + 20.0 + x3), 1e-12);
  EXPECT_TRUE(broken_assumptions(section).empty());
  section.base = 5.0;
  section.landside.cover_conductivity = 5e-5;
  EXPECT_EQ(broken_assumptions(section).size(), 2U);
}

}  // namespace check_formulas_test
}  // namespace suffuse
