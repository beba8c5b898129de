#include "boundary/face_conditions.hpp"

#include <gtest/gtest.h>

#include "solver/model_case.hpp"

namespace suffuse {
namespace face_conditions_test {

using Knots = std::vector<std::pair<double, double>>;

/// A column under a pressure that rises from 0 to 6 kPa between 2 s and 10 s, with a flux at the
/// foot that changes its sign and carries grains, and a constant table on the left.
struct Column {
  explicit Column(std::vector<BoundaryCondition> boundaries,
                  const std::array<double, 3>& gravity = {})
      : c(make(std::move(boundaries), gravity)), grid(c.mesh), values(c, grid) {}
  static Case<2> make(std::vector<BoundaryCondition> boundaries,
                      const std::array<double, 3>& gravity) {
    Scene scene = model::paper_scene();
    scene.gravity = gravity;
    scene.time.end = 20.0;
    scene.boundaries = std::move(boundaries);
    return model::make_case(model::column_mesh(3, 2), scene);
  }
  /// The condition of all faces of a boundary, which must be equal.
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

  /// The conditions of a boundary's faces, in the order of the mesh.
  [[nodiscard]] std::vector<FaceCondition> all_on(
      const std::string& name, const std::vector<FaceCondition>& conditions) const {
    std::vector<FaceCondition> result;
    for (const auto& set : c.mesh.boundaries) {
      if (set.name != name) continue;
      for (const auto& nodes : set.faces) result.push_back(conditions[grid.find_face(nodes)]);
    }
    return result;
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

/// Knots inside (0, end) of values that change, ascending, each once: 2 and 10 of the pressure, 4
/// and 10 of the flux with its grains; not 0, -1 and 30, and none of the constant table.
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

constexpr std::array<double, 3> downwards{0.0, -10.0, 0.0};

BoundaryCondition head_on(const std::string& name, const TimeFunction& head,
                          DryPart dry = DryPart::seepage) {
  BoundaryCondition b;
  b.on = name;
  b.head = head;
  b.dry = dry;
  return b;
}

/// The left side has two faces, with centres at z = 0.25 and 0.75: rho_w |g| = 10 kN/m3.
TEST(HeadBoundary, is_hydrostatic_below_its_level_and_a_seepage_face_above) {
  const Column column({head_on("left", 0.5)}, downwards);
  const auto faces = column.all_on("left", column.values.at(0.0));
  ASSERT_EQ(faces.size(), 2U);
  EXPECT_EQ(faces[0].kind, FaceKind::pressure);
  EXPECT_NEAR(faces[0].value, 2500.0, 1e-9);
  EXPECT_FALSE(faces[0].switches);  // always below the level
  EXPECT_EQ(faces[1].kind, FaceKind::seepage);
  EXPECT_EQ(faces[1].value, 0.0);
  EXPECT_TRUE(faces[1].switches);
  EXPECT_FALSE(column.values.vary());
}

TEST(HeadBoundary, may_be_impervious_or_under_suction_above_its_level) {
  const Column walled({head_on("left", 0.5, DryPart::impervious)}, downwards);
  const auto wall = walled.all_on("left", walled.values.at(0.0));
  EXPECT_EQ(wall[0].kind, FaceKind::pressure);
  EXPECT_EQ(wall[1].kind, FaceKind::wall);
  EXPECT_FALSE(wall[1].switches);  // for the whole run
  EXPECT_EQ(wall[1].boundary, 0);
  const Column sucking({head_on("left", 0.5, DryPart::suction)}, downwards);
  const auto suction = sucking.all_on("left", sucking.values.at(0.0));
  EXPECT_EQ(suction[1].kind, FaceKind::pressure);
  EXPECT_NEAR(suction[1].value, -2500.0, 1e-9);
  EXPECT_FALSE(suction[1].switches);
}

/// The level rises from 0 at t = 0 to 1 m at 10 s and falls to 0.5 m at 30 s, after the end at 20
/// s.
TEST(HeadBoundary, switches_the_faces_that_its_level_passes) {
  for (const DryPart dry : {DryPart::seepage, DryPart::impervious}) {
    const TimeFunction flood(Knots{{0.0, 0.0}, {10.0, 1.0}, {30.0, 0.5}});
    const Column column({head_on("left", flood, dry)}, downwards);
    const FaceKind above = dry == DryPart::seepage ? FaceKind::seepage : FaceKind::wall;
    auto conditions = column.values.at(0.0);
    for (const auto& face : column.all_on("left", conditions)) {
      EXPECT_EQ(face.kind, above);
      EXPECT_TRUE(face.switches);
    }
    column.values.update(5.0, conditions);
    const auto half = column.all_on("left", conditions);
    EXPECT_EQ(half[0].kind, FaceKind::pressure);
    EXPECT_NEAR(half[0].value, 2500.0, 1e-9);
    EXPECT_EQ(half[1].kind, above);
    EXPECT_EQ(half[1].value, 0.0);
    column.values.update(20.0, conditions);
    const auto falling = column.all_on("left", conditions);
    EXPECT_EQ(falling[1].kind, above);  // the level is at its centre
    EXPECT_TRUE(falling[1].switches);
    column.values.update(15.0, conditions);
    const auto high = column.all_on("left", conditions);
    EXPECT_EQ(high[1].kind, FaceKind::pressure);
    EXPECT_NEAR(high[1].value, 1250.0, 1e-9);
    EXPECT_EQ(column.values.breakpoints(), std::vector{10.0});
  }
}

/// A face that the level crosses is dry if the level is at its centre; level ground is wet if the
/// level is at its height.
TEST(HeadBoundary, takes_level_ground_at_its_level_for_wet) {
  const Column column({head_on("left", 0.75)}, downwards);
  EXPECT_EQ(column.all_on("left", column.values.at(0.0))[1].kind, FaceKind::seepage);
  for (const DryPart dry : {DryPart::seepage, DryPart::impervious}) {
    for (const double head : {1.0, std::nextafter(1.0, 0.0)}) {
      const Column top({head_on("top", head, dry)}, downwards);
      const FaceCondition face = top.on("top", top.values.at(0.0));
      EXPECT_EQ(face.kind, FaceKind::pressure);
      EXPECT_NEAR(face.value, 0.0, 1e-11);
      EXPECT_FALSE(face.switches);
    }
  }
  const Column below({head_on("top", 0.9999)}, downwards);
  EXPECT_EQ(below.on("top", below.values.at(0.0)).kind, FaceKind::seepage);
}

/// The level rises to the ground and falls again.
TEST(HeadBoundary, opens_level_ground_while_its_level_is_there) {
  const TimeFunction flood(Knots{{0.0, 0.0}, {10.0, 1.0}, {15.0, 1.0}, {20.0, 0.0}});
  const Column column({head_on("top", flood, DryPart::impervious)}, downwards);
  const auto kind_at = [&](double time) { return column.on("top", column.values.at(time)).kind; };
  EXPECT_EQ(kind_at(5.0), FaceKind::wall);
  EXPECT_TRUE(column.on("top", column.values.at(5.0)).switches);
  EXPECT_EQ(kind_at(12.0), FaceKind::pressure);
  EXPECT_EQ(kind_at(18.0), FaceKind::wall);
}

/// Heights are measured against gravity in any direction: here along x, so the left side is level.
TEST(HeadBoundary, measures_heights_against_gravity) {
  const Column column({head_on("left", 2.0), head_on("top", 2.0)}, {-4.0, 0.0, 0.0});
  const auto left = column.all_on("left", column.values.at(0.0));
  EXPECT_NEAR(left[0].value, 4000.0 * 2.0, 1e-9);
  EXPECT_NEAR(left[1].value, 4000.0 * 2.0, 1e-9);
  const auto top = column.all_on("top", column.values.at(0.0));  // centres at x = 1/6, 1/2, 5/6
  ASSERT_EQ(top.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(top[i].value, 4000.0 * (2.0 - (2 * i + 1) / 6.0), 1e-9) << i;
  }
}

TEST(HeadBoundary, is_an_excess_head_without_gravity) {
  const Column column({head_on("left", TimeFunction(Knots{{0.0, -1.0}, {10.0, 3.0}}))});
  for (const double time : {0.0, 5.0, 10.0}) {
    const FaceCondition now = column.on("left", column.values.at(time));
    EXPECT_EQ(now.kind, FaceKind::pressure);
    EXPECT_NEAR(now.value, 9810.0 * (-1.0 + 0.4 * time), 1e-9);
    EXPECT_FALSE(now.switches);
  }
}

TEST(SeepageFace, lets_out_and_rain_comes_in) {
  const BoundaryCondition drain = model::seepage_on("right");
  BoundaryCondition rain;
  rain.on = "top";
  rain.rain = TimeFunction(Knots{{0.0, 0.0}, {10.0, 2e-6}});
  const Column column({drain, rain}, downwards);
  auto conditions = column.values.at(0.0);
  EXPECT_EQ(column.on("right", conditions).kind, FaceKind::seepage);
  EXPECT_EQ(column.on("right", conditions).value, 0.0);
  EXPECT_TRUE(column.on("right", conditions).switches);
  column.values.update(5.0, conditions);
  EXPECT_EQ(column.on("top", conditions).kind, FaceKind::seepage);
  EXPECT_NEAR(column.on("top", conditions).value, 1e-6, 1e-20);
  EXPECT_TRUE(column.on("top", conditions).switches);
}

/// Faces of different lengths share a rate in proportion to their lengths: the flux is uniform.
TEST(Well, spreads_its_rate_over_its_faces) {
  BoundaryCondition well;
  well.on = "top";
  well.key = "well[0]";
  well.rate = TimeFunction(Knots{{0.0, -0.5}, {10.0, 1.5}});
  Case<2> c = Column::make({well}, {});
  c.mesh = model::column_mesh(
      3, 2, 2.0, 1.0, [](const Vector<2>& x) { return Vector<2>(x[0] * x[0] / 2.0, x[1]); });
  const Grid<2> grid(c.mesh);
  const BoundaryValues<2> values(c, grid);
  for (const double time : {0.0, 5.0}) {
    const auto conditions = values.at(time);
    double rate = 0.0;
    for (const auto& nodes : c.mesh.boundaries[0].faces) {
      const int f = grid.find_face(nodes);
      EXPECT_EQ(conditions[f].kind, FaceKind::flux);
      rate += conditions[f].value * grid.face_normal[f].norm();
    }
    EXPECT_NEAR(rate, time == 0.0 ? -0.5 : 0.5, 1e-15);
  }
}

}  // namespace face_conditions_test
}  // namespace suffuse
