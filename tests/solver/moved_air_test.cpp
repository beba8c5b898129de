/// Water and air that moving soil carries along.

#include "coupling/moved_air.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "mixed/flow_soils.hpp"
#include "model_case.hpp"

namespace suffuse {
namespace moved_air_test {

class MovedAirTest : public testing::Test {
 protected:
  MovedAirTest() : grid_(mesh_), porosity_(grid_.mesh.element_count(), 0.4) {
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      // Half filled.
      const double side = 0.5 * 0.4 * grid_.volume[e] / 3.0;
      state_.air.push_back({side, side, side});
    }
    for (const Vector<2>& normal : grid_.face_normal) {
      shift_.push_back(normal.dot(Vector<2>(0.001, -0.002)));
    }
    state_.face_pressure.assign(shift_.size(), -1e3);
    conditions_.resize(shift_.size());
    share_.assign(porosity_.size(), 1.0);
  }

  [[nodiscard]] ElementPores pores() const {
    std::vector<double> gap(porosity_.size());
    for (std::size_t e = 0; e < gap.size(); ++e) gap[e] = gap_ * grid_.volume[e];
    return {porosity_, share_, gap};
  }
  /// Water stands outside of all outer faces.
  void flood() {
    state_.face_pressure.assign(shift_.size(), 1e3);
    for (FaceCondition& condition : conditions_) condition.kind = FaceKind::pressure;
  }
  [[nodiscard]] double outflow(int e, const std::vector<double>& through) const {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      sum += grid_.element_face_sign[e][k] * through[grid_.element_face[e][k]];
    }
    return sum;
  }

  Mesh<2> mesh_ = model::column_mesh(4, 4);
  Grid<2> grid_;
  std::vector<double> porosity_;
  std::vector<FaceCondition> conditions_;
  MixedState<2> state_;
  std::vector<double> share_;  ///< of soil in the pores of elements
  double gap_ = 0.0;           ///< over the volume of elements
  std::vector<double> shift_;  ///< of a body that moves as a whole, m3
};

TEST_F(MovedAirTest, ABodyThatMovesAsAWholeCarriesItsWater) {
  const MovedAir<2> moved(grid_, conditions_, state_, pores(), shift_);
  const std::vector<double> saturation(porosity_.size(), 0.5);
  std::vector<char> inside(porosity_.size(), 1);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (grid_.is_outer(f)) {
      inside[grid_.face_left[f]] = 0;
      continue;
    }
    EXPECT_NEAR(moved.without_air(f), (1.0 - 0.5 * 0.4) * shift_[f], 1e-16);
    EXPECT_NEAR(moved.water(f, 0.6 * shift_[f], saturation), 0.2 * shift_[f], 1e-16);
  }
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (inside[e] == 0) continue;
    EXPECT_NEAR(moved.pores_gained(e), 0.0, 1e-16);
  }
}

/// The body's saturation, 0.5, does not change at the boundary, where it leaves room or needs it.
TEST_F(MovedAirTest, SoilAtTheOuterBoundaryKeepsItsSaturation) {
  const MovedAir<2> moved(grid_, conditions_, state_, pores(), shift_);
  const std::vector<double> saturation(porosity_.size(), 0.5);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    double gained = 0.0;  // of water
    for (int k = 0; k < 3; ++k) {
      const int f = grid_.element_face[e][k];
      const double solid = grid_.is_outer(f) ? 0.0 : 0.6 * shift_[f];
      gained -= grid_.element_face_sign[e][k] * moved.water(f, solid, saturation);
    }
    EXPECT_NEAR(gained, 0.5 * moved.pores_gained(e), 1e-16);
  }
}

TEST_F(MovedAirTest, AirTakesThePlaceOfFreeSpaceAtTheOuterBoundary) {
  share_.assign(porosity_.size(), 0.0);
  const MovedAir<2> moved(grid_, conditions_, state_, pores(), shift_);
  const std::vector<double> saturation(porosity_.size(), 0.5);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    EXPECT_EQ(moved.without_air(f), 0.0);
    EXPECT_EQ(moved.water(f, 0.0, saturation), 0.0);
  }
}

/// The volume that soil leaves at a boundary under water, or takes from it, is water.
TEST_F(MovedAirTest, WaterTakesThePlaceOfSoilThatLeavesABoundaryUnderWater) {
  flood();
  const MovedAir<2> moved(grid_, conditions_, state_, pores(), shift_);
  const std::vector<double> saturation(porosity_.size(), 0.5);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    EXPECT_EQ(moved.without_air(f), shift_[f]);
    EXPECT_EQ(moved.water(f, 0.0, saturation), shift_[f]);
  }
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    double solid = 0.0;  // leaves through inner faces alone
    for (int k = 0; k < 3; ++k) {
      const int f = grid_.element_face[e][k];
      if (!grid_.is_outer(f)) solid += grid_.element_face_sign[e][k] * 0.6 * shift_[f];
    }
    EXPECT_NEAR(moved.pores_gained(e), solid, 1e-16);
  }
}

/// Under water soil that has sunk rises to the boundary first, and soil that has swelled shrinks
/// back to it: water crosses for the rest.
TEST_F(MovedAirTest, AGapClosesUnderWater) {
  flood();
  const std::vector<double> saturation(porosity_.size(), 0.5);
  for (const double gap : {-0.01, 0.01}) {
    gap_ = gap;
    const MovedAir<2> moved(grid_, conditions_, state_, pores(), shift_);
    std::vector<double> left = pores().gap;
    for (int f = 0; f < grid_.face_count(); ++f) {
      if (!grid_.is_outer(f)) continue;
      double& of_element = left[grid_.face_left[f]];
      const bool closes = shift_[f] * gap > 0.0;
      const double most = closes ? std::min(std::abs(shift_[f]), std::abs(of_element)) : 0.0;
      const double closed = std::copysign(most, gap);
      of_element -= closed;
      EXPECT_NEAR(moved.water(f, 0.0, saturation), shift_[f] - closed, 1e-16);
      EXPECT_NEAR(moved.without_air(f), shift_[f], 1e-16);
    }
  }
}

/// A load presses soil from an impervious boundary, and its water is under pressure: no water comes
/// to where the soil was.
TEST_F(MovedAirTest, NoWaterCrossesAnImperviousBoundaryUnderPressure) {
  state_.face_pressure.assign(shift_.size(), 1e3);
  const MovedAir<2> moved(grid_, conditions_, state_, pores(), shift_);
  const std::vector<double> saturation(porosity_.size(), 0.5);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    EXPECT_EQ(moved.without_air(f), shift_[f]);
    EXPECT_EQ(moved.water(f, 0.0, saturation), 0.0);
  }
}

/// No more than nine tenths of the room of an element is a gap. Beyond that soil leaves its place
/// to air.
TEST_F(MovedAirTest, AGapIsSmallerThanThePores) {
  porosity_.assign(porosity_.size(), 0.08);
  gap_ = 0.72;
  std::vector<double> falls(shift_.size(), 0.0);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (grid_.is_outer(f)) falls[f] = -1.0;
  }
  const MovedAir<2> moved(grid_, conditions_, state_, pores(), falls);
  for (int f = 0; f < grid_.face_count(); ++f) {
    if (!grid_.is_outer(f)) continue;
    EXPECT_NEAR(moved.without_air(f), 0.0, 1e-16);
  }
}

TEST_F(MovedAirTest, SoilComesFromTheElementBehindIt) {
  int f = 0;
  while (grid_.is_outer(f) || shift_[f] <= 0.0) ++f;
  porosity_[grid_.face_right[f]] = 0.9;
  const MovedAir<2> with(grid_, conditions_, state_, pores(), shift_);
  EXPECT_NEAR(with.without_air(f), 0.8 * shift_[f], 1e-16);
  std::vector<double> back = shift_;
  for (double& v : back) v = -v;
  const MovedAir<2> against(grid_, conditions_, state_, pores(), back);
  const double air = 0.5 * 0.4;
  EXPECT_NEAR(against.without_air(f), (1.0 - air) * back[f], 1e-16);
}

/// Solid that moves without its soil displaces water at its new place.
TEST_F(MovedAirTest, NoElementGivesWaterThatItDoesNotHave) {
  int f = 0;
  while (grid_.is_outer(f)) ++f;
  const std::vector<double> volume(grid_.face_count(), 0.0);
  const MovedAir<2> still(grid_, conditions_, state_, pores(), volume);
  std::vector<double> saturation(porosity_.size(), 1.0);
  saturation[grid_.face_right[f]] = 0.0;
  EXPECT_DOUBLE_EQ(still.water(f, 0.01, saturation), 0.0);
  EXPECT_DOUBLE_EQ(still.water(f, -0.01, saturation), 0.01);
}

TEST_F(MovedAirTest, AirTakesThePlaceOfWhatLeaves) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> some(-1e-3, 1e-3);
  SolidMotion motion;
  motion.face_volume = shift_;
  motion.solid_gain.assign(porosity_.size(), 0.0);
  MixedStep<2> step;
  step.end.air = state_.air;
  for (int f = 0; f < grid_.face_count(); ++f) {
    motion.solid_face_volume.push_back(0.6 * shift_[f] + some(random));
    step.face_volume.push_back(some(random));
  }
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    motion.solid_gain[e] = -outflow(e, motion.solid_face_volume);
  }
  const std::vector<double> room = move_liquid(grid_, conditions_, motion, state_, pores(), step);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const double gained = element_sum<2>(step.end.air[e]) - element_sum<2>(state_.air[e]);
    double left = outflow(e, step.face_volume) + outflow(e, motion.solid_face_volume);
    EXPECT_NEAR(room[e], gained - outflow(e, step.face_volume), 1e-16);
    for (int k = 0; k < 3; ++k) {
      const int f = grid_.element_face[e][k];
      if (grid_.is_outer(f)) left += shift_[f];  // the gap shrinks
    }
    EXPECT_NEAR(gained, left, 1e-16);
  }
}

/// A side without air gives none, and a side without water takes none.
TEST_F(MovedAirTest, AirOfASideStaysWithinItsRoom) {
  std::vector<double> volume(grid_.face_count(), 0.0);
  SolidMotion still;
  still.face_volume = still.solid_face_volume = volume;
  still.solid_gain.assign(porosity_.size(), 0.0);
  for (const double moved : {-0.3, 0.3}) {
    MixedStep<2> step;
    step.face_volume = volume;
    step.end.air = state_.air;
    ElementField<2>& before = state_.air;
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      const double room = porosity_[e] * grid_.volume[e] / 3.0;
      step.end.air[e] = {0.0, 0.5 * room, room};
      before[e] = {0.0, 0.5 * room, (1.0 + moved) * room};
    }
    move_liquid(grid_, conditions_, still, state_, pores(), step);
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      const double room = porosity_[e] * grid_.volume[e] / 3.0;
      for (const double air : step.end.air[e]) {
        EXPECT_GE(air, 0.0);
        EXPECT_LE(air, room * (1.0 + 1e-12));
      }
      EXPECT_NEAR(element_sum<2>(step.end.air[e]), (1.5 + moved) * room, 1e-15);
    }
  }
}

/// Compares the slopes of a state with difference quotients.
void expect_slopes(const auto& at, double x, double near) {
  const RetentionState low = at(x - near);
  const RetentionState high = at(x + near);
  const RetentionState here = at(x);
  const double digits = 1e-15 * here.saturation / near;  // of the quotients
  const double capacity = (high.saturation - low.saturation) / (2.0 * near);
  EXPECT_NEAR(here.capacity, capacity, 1e-6 * capacity + digits) << x;
  const double slope = (high.relative_conductivity - low.relative_conductivity) / (2.0 * near);
  EXPECT_NEAR(here.conductivity_slope, slope, 1e-6 * slope + digits) << x;
}

TEST(Retention, KnowsItsSlopes) {
  for (const double n : {1.3, 2.0, 2.5, 8.0}) {
    const RetentionModel soil = model::van_genuchten(3.0, n, 0.0);
    for (const double psi : {-0.01, -0.3, -3.0, -300.0}) {
      expect_slopes([&](double x) { return soil.at(x); }, psi, 1e-5 * -psi);
    }
  }
  const RetentionModel soil = model::gardner(3.0, 0.0);
  expect_slopes([&](double x) { return soil.at(x); }, -0.3, 1e-5);
}

/// k_r keeps its digits in dry soil, where it is (n - 1)^2 / n^2 (alpha psi)^(1 / 2 - 5 n / 2), and
/// neither law overflows.
TEST(Retention, KeepsItsDigitsInDrySoil) {
  constexpr double n = 2.0;
  const RetentionModel soil = model::van_genuchten(1.0, n, 0.0);
  const double dry = 0.25 * std::pow(1e6, 0.5 - 2.5 * n);
  EXPECT_NEAR(soil.at(-1e6).relative_conductivity / dry, 1.0, 1e-9);
  EXPECT_NEAR(soil.at(-1e300).saturation / 1e-300, 1.0, 1e-9);
  EXPECT_EQ(soil.at(-1e-300).saturation, 1.0);
  EXPECT_EQ(soil.at(-1e-300).relative_conductivity, 1.0);
}

/// Moving soil may be drier than its residual saturation; its capacity is the slope of its
/// saturation.
TEST(DryingSoil, LosesWhatItRetains) {
  const RetentionModel keeps = model::van_genuchten(3.0, 2.5, 0.1);
  RetentionModel soil = keeps;
  soil.dries_at = 1000.0;
  EXPECT_NEAR(soil.at(-1000.0).saturation, 0.05, 1e-4);
  EXPECT_NEAR(soil.at(-1.0).saturation, keeps.at(-1.0).saturation, 1e-6);
  for (const double psi : {-0.3, -3.0, -300.0, -3000.0}) {
    expect_slopes([&](double x) { return soil.at(x); }, psi, 1e-5 * -psi);
  }
  EXPECT_EQ(soil.effective(0.05), 0.0);
  EXPECT_NEAR(soil.effective(0.55), 0.5, 1e-15);
}

/// An element at the surface of the soil retains water as a mixture of its soil and free space, by
/// their shares.
TEST(FlowSoils, MixWhereSoilFillsAPart) {
  FlowSoils<2> soils;
  soils.head_per_pressure = 1e-4;
  soils.retention = {model::van_genuchten(3.0, 2.5, 0.1), model::van_genuchten(3.0, 2.5, 0.1)};
  soils.free_space = model::van_genuchten(30.0, 3.0, 0.0);
  soils.soil_share = {1.0, 0.25};
  const double pressure = -4e3;
  const double soil = soils.retention[0].at(-0.4).saturation;
  EXPECT_DOUBLE_EQ(soils.at(0, pressure).saturation, soil);
  EXPECT_NEAR(soils.at(1, pressure).saturation,
              0.25 * soil + 0.75 * soils.free_space.at(-0.4).saturation, 1e-15);
  expect_slopes([&](double x) { return soils.at(1, x); }, pressure, 1.0);
  // Suction acts by the effective saturation of both.
  EXPECT_NEAR(soils.suction_share(1, 0.5125), 0.5, 1e-15);
  EXPECT_NEAR(soils.suction_share(0, 0.55), 0.5, 1e-15);
}

}  // namespace moved_air_test
}  // namespace suffuse
