#include "flow/face_conditions.hpp"

#include <gtest/gtest.h>

#include "solver/model_case.hpp"

namespace suffuse {
namespace {

using Knots = std::vector<std::pair<double, double>>;

/// A column under a pressure that rises from 0 to 6 kPa between 2 s and 10 s, with a flux at the
/// foot that turns, grains that come with it, and a level table on the left.
struct Column {
  explicit Column(std::vector<BoundaryCondition> boundaries)
      : c(make(std::move(boundaries))), grid(c.mesh), values(c, grid) {}
  static Case<2> make(std::vector<BoundaryCondition> boundaries) {
    Scene scene = model::paper_scene();
    scene.time.end = 20.0;
    scene.boundaries = std::move(boundaries);
    return model::make_case(model::column_mesh(3, 2), scene);
  }
  /// The condition of every face of a boundary, which must be the same.
  [[nodiscard]] FaceCondition on(const std::string& name,
                                 const std::vector<FaceCondition>& conditions) const {
    const FaceCondition* found = nullptr;
    for (const auto& set : c.mesh.boundaries) {
      if (set.name != name) continue;
      for (const auto& nodes : set.faces) {
        const FaceCondition& condition = conditions[grid.find_face(nodes)];
        if (found) {
          EXPECT_EQ(condition.value, found->value);
          EXPECT_EQ(condition.concentration, found->concentration);
        }
        found = &condition;
      }
    }
    return found ? *found : FaceCondition{};
  }

  Case<2> c;
  Grid<2> grid;
  BoundaryValues<2> values;
};

BoundaryCondition rising_pressure() {
  BoundaryCondition b;
  b.on = "top";
  b.pressure = TimeFunction(Knots{{2.0, 0.0}, {10.0, 6000.0}});
  return b;
}

BoundaryCondition turning_flux() {
  BoundaryCondition b;
  b.on = "bottom";
  b.darcy_flux = TimeFunction(Knots{{0.0, -0.01}, {10.0, 0.01}, {30.0, 0.02}});
  b.concentration = TimeFunction(Knots{{-1.0, 0.0}, {4.0, 0.1}});
  return b;
}

BoundaryCondition level_velocity() {
  BoundaryCondition b;
  b.on = "left";
  b.velocity = TimeFunction(Knots{{1.0, 0.04}, {5.0, 0.04}});
  return b;
}

TEST(BoundaryValues, ChangeInTime) {
  const Column column({rising_pressure(), turning_flux(), level_velocity()});
  EXPECT_TRUE(column.values.vary());
  const auto start = column.values.at(0.0);
  EXPECT_EQ(column.on("top", start).kind, FaceKind::pressure);
  EXPECT_EQ(column.on("top", start).value, 0.0);
  EXPECT_EQ(column.on("bottom", start).kind, FaceKind::flux);
  EXPECT_EQ(column.on("bottom", start).value, -0.01);
  EXPECT_NEAR(column.on("bottom", start).concentration, 0.02, 1e-16);
  EXPECT_TRUE(column.on("bottom", start).concentration_given);
  EXPECT_EQ(column.on("left", start).kind, FaceKind::velocity);
  EXPECT_EQ(column.on("left", start).value, 0.04);
  EXPECT_EQ(column.on("right", start).kind, FaceKind::wall);

  const auto later = column.values.at(8.0);
  EXPECT_EQ(column.on("top", later).value, 4500.0);
  EXPECT_NEAR(column.on("bottom", later).value, 0.006, 1e-17);
  EXPECT_EQ(column.on("bottom", later).concentration, 0.1);
  EXPECT_EQ(column.on("left", later).value, 0.04);
  EXPECT_EQ(column.on("top", column.values.at(20.0)).value, 6000.0);
}

TEST(BoundaryValues, AreThoseOfFaceConditionsAtTheStart) {
  const Column column({rising_pressure(), turning_flux(), level_velocity()});
  const auto from_case = face_conditions(column.c, column.grid);
  const auto at_start = column.values.at(0.0);
  ASSERT_EQ(from_case.size(), at_start.size());
  for (std::size_t f = 0; f < from_case.size(); ++f) {
    EXPECT_EQ(from_case[f].kind, at_start[f].kind) << f;
    EXPECT_EQ(from_case[f].value, at_start[f].value) << f;
    EXPECT_EQ(from_case[f].concentration, at_start[f].concentration) << f;
    EXPECT_EQ(from_case[f].boundary, at_start[f].boundary) << f;
  }
}

TEST(BoundaryValues, AreUpdatedInPlaceFromAnyTime) {
  const Column column({rising_pressure(), turning_flux(), level_velocity()});
  auto conditions = column.values.at(13.0);
  for (const double time : {8.0, 3.5, 20.0}) {
    column.values.update(time, conditions);
    const auto fresh = column.values.at(time);
    for (std::size_t f = 0; f < fresh.size(); ++f) {
      EXPECT_EQ(conditions[f].kind, fresh[f].kind);
      EXPECT_EQ(conditions[f].value, fresh[f].value);
      EXPECT_EQ(conditions[f].concentration, fresh[f].concentration);
    }
  }
}

TEST(BoundaryValues, GiveConcentrationsOfAnotherTime) {
  const Column column({rising_pressure(), turning_flux(), level_velocity()});
  auto conditions = column.values.at(8.0);
  column.values.update_concentrations(1.5, conditions);
  EXPECT_NEAR(column.on("bottom", conditions).concentration, 0.05, 1e-16);
  EXPECT_NEAR(column.on("bottom", conditions).value, 0.006, 1e-17);
  EXPECT_EQ(column.on("top", conditions).value, 4500.0);
}

TEST(BoundaryValues, TouchNoFaceThatDoesNotChange) {
  const Column column({rising_pressure(), level_velocity()});
  auto conditions = column.values.at(0.0);
  for (FaceCondition& condition : conditions) condition.value = -77.0;
  column.values.update(8.0, conditions);
  EXPECT_EQ(column.on("top", conditions).value, 4500.0);
  EXPECT_EQ(column.on("left", conditions).value, -77.0);
  EXPECT_EQ(column.on("right", conditions).value, -77.0);
}

/// Knots inside (0, end) of what changes, ascending, each once: 2 and 10 of the pressure, 4 and 10
/// of the flux with its grains; not 0, -1 and 30, and none of the level table.
TEST(BoundaryValues, HaveEventsWithinTheRun) {
  const Column column({rising_pressure(), turning_flux(), level_velocity()});
  EXPECT_EQ(column.values.breakpoints(), (std::vector{2.0, 4.0, 10.0}));
}

TEST(BoundaryValues, DoNotVaryWhereAllAreLevel) {
  const Column column({model::pressure_on("top", 6000.0), level_velocity()});
  EXPECT_FALSE(column.values.vary());
  EXPECT_TRUE(column.values.breakpoints().empty());
  EXPECT_EQ(column.on("top", column.values.at(15.0)).value, 6000.0);
}

}  // namespace
}  // namespace suffuse
