/// Liquid points that carry the flow. Each step is compared with a plain version that walks every
/// point from face to face; also threads, balances, and the blocks that hold the points.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

#include "solver/carried_column.hpp"

namespace suffuse {
namespace carried_points_test {

using model::Column;
using model::fast_column;

/// The same liquid in a plain version: one loop over all points per task, every point is walked.
class PlainLiquid {
 public:
  explicit PlainLiquid(const Column& column) : points(column.points()), inflow_(column.inflow()) {}

  void points_to_grid(const Grid<2>& grid, VectorField<2>& velocity,
                      std::vector<double>& pressure) {
    VectorField<2> momentum(velocity.size(), Vector<2>::Zero());
    std::vector<double> mass(velocity.size(), 0.0);
    std::vector<double> work(pressure.size(), 0.0);
    std::vector<double> volume(pressure.size(), 0.0);
    for (int p = 0; p < points.size(); ++p) {
      const int e = points.element[p];
      const double v =
          liquid_volume(points.water_mass[p], points.fines_mass[p], Column::densities_, 1.0);
      work[e] += v * points.pressure[p];
      volume[e] += v;
      for (int a = 0; a < 3; ++a) {
        const int i = grid.mesh.elements[e][a];
        const double share =
            points.barycentric[p][a] * (points.water_mass[p] + points.fines_mass[p]);
        mass[i] += share;
        momentum[i] += share * points.velocity[p];
      }
    }
    for (std::size_t i = 0; i < mass.size(); ++i) {
      if (mass[i] > 0.0) velocity[i] = momentum[i] / mass[i];
    }
    for (std::size_t e = 0; e < volume.size(); ++e) {
      if (volume[e] > 0.0) pressure[e] = work[e] / volume[e];
    }
  }

  /// To be called after `column` has moved its own points.
  void grid_to_points(Column& column, const VectorField<2>& velocity_before,
                      const std::vector<double>& pressure_before) {
    const Grid<2>& grid = column.grid();
    const VectorField<2>& velocity = column.flow().scheme().velocity();
    const std::vector<double>& pressure = column.flow().pressure();
    std::vector<double> time(points.size(), column.dt);
    std::vector<int> from;
    for (int p = 0; p < points.size(); ++p) {
      const int e = points.element[p];
      points.pressure[p] += pressure[e] - pressure_before[e];
      points.velocity[p] += interpolate(grid, points.place(p), velocity) -
                            interpolate(grid, points.place(p), velocity_before);
      from.push_back(grid.mesh.element_region[e]);
    }
    for (const ArrivingPoint<2>& arriving : column.inject(inflow_)) {
      add(arriving);
      time.push_back(arriving.time);
      from.push_back(-1);
    }
    std::vector<unsigned char> keep;
    for (int p = 0; p < points.size(); ++p) {
      PointPlace<2> place = points.place(p);
      const int left_by = walk(grid, column.walk_field(), place, time[p], points.id[p]);
      const int to = left_by < 0 ? grid.mesh.element_region[place.element] : -1;
      if (from[p] != to || to < 0) crossed[{from[p], to}] += points.water_mass[p];
      keep.push_back(left_by < 0);
      points.element[p] = place.element;
      points.barycentric[p] = place.barycentric;
      if (left_by < 0) continue;
      Column::account_for({from[p], to, -1, left_by, points.water_mass[p], points.fines_mass[p]},
                          inflow_);
    }
    keep_points(points, keep);
  }

  LiquidPoints<2> points;
  std::map<std::pair<int, int>, double> crossed;

 private:
  void add(const ArrivingPoint<2>& arriving) {
    points.element.push_back(arriving.place.element);
    points.barycentric.push_back(arriving.place.barycentric);
    points.water_mass.push_back(arriving.point.water_mass);
    points.fines_mass.push_back(arriving.point.fines_mass);
    points.id.push_back(arriving.point.id);
    points.pressure.push_back(arriving.point.pressure);
    points.velocity.push_back(arriving.point.velocity);
  }

  InflowAccount inflow_;
};

/// Index of each point by its id.
std::map<long, int> by_id(const LiquidPoints<2>& points) {
  std::map<long, int> result;
  for (int p = 0; p < points.size(); ++p) result[points.id[p]] = p;
  return result;
}

/// Largest differences between two sets of the same points.
struct Differences {
  double place = 0.0;
  double velocity = 0.0;
  double pressure = 0.0;
};
Differences compare(const Mesh<2>& mesh, const LiquidPoints<2>& a, const LiquidPoints<2>& b) {
  Differences worst;
  const auto of_a = by_id(a);
  const auto of_b = by_id(b);
  EXPECT_EQ(of_a.size(), static_cast<std::size_t>(a.size()));
  EXPECT_EQ(a.size(), b.size());
  for (const auto& [id, p] : of_a) {
    const auto found = of_b.find(id);
    if (found == of_b.end()) {
      ADD_FAILURE() << "point " << id << " is in one of them alone";
      continue;
    }
    const int q = found->second;
    worst.place =
        std::max(worst.place, (a.place(p).position(mesh) - b.place(q).position(mesh)).norm());
    worst.velocity = std::max(worst.velocity, (a.velocity[p] - b.velocity[q]).norm());
    worst.pressure = std::max(worst.pressure, std::abs(a.pressure[p] - b.pressure[q]));
    EXPECT_EQ(a.water_mass[p], b.water_mass[q]);
    EXPECT_EQ(a.fines_mass[p], b.fines_mass[q]);
  }
  return worst;
}

TEST(CarriedPoints, DoWhatThePlainWayDoes) {
  const Case<2> c = fast_column(4);
  Column column(c);
  PlainLiquid plain(column);
  double at_nodes = 0.0;
  double in_elements = 0.0;
  double speed = 0.0;
  double largest = 0.0;
  constexpr int steps = 400;
  for (int k = 0; k < steps; ++k) {
    auto& scheme = column.flow().scheme();
    scheme.rewrite([&](auto& velocity, auto& pressure) {
      plain.points_to_grid(column.grid(), velocity, pressure);
    });
    const VectorField<2> velocity = scheme.velocity();
    const std::vector<double> pressure = scheme.pressure();
    column.points_to_grid();
    for (std::size_t i = 0; i < velocity.size(); ++i) {
      at_nodes = std::max(at_nodes, (scheme.velocity()[i] - velocity[i]).norm());
      speed = std::max(speed, velocity[i].norm());
    }
    for (std::size_t e = 0; e < pressure.size(); ++e) {
      in_elements = std::max(in_elements, std::abs(scheme.pressure()[e] - pressure[e]));
      largest = std::max(largest, std::abs(pressure[e]));
    }
    const VectorField<2> velocity_before = scheme.velocity();
    const std::vector<double> pressure_before = scheme.pressure();
    column.step();
    column.grid_to_points();
    plain.grid_to_points(column, velocity_before, pressure_before);
  }
  const Differences off = compare(c.mesh, column.points(), plain.points);
  std::cout << steps << " steps: " << column.count << " crossings of regions, "
            << column.inflow().next_id - c.liquid_points.size() << " points injected, "
            << column.points().size() << " points; off by " << off.place << " m, "
            << off.velocity / speed << " of the largest speed, " << off.pressure / largest
            << " of the largest pressure; at nodes " << at_nodes / speed << ", in elements "
            << in_elements / largest << "\n";
  EXPECT_LE(off.place, 1e-12);
  EXPECT_LE(off.velocity, 1e-11 * speed);
  EXPECT_LE(off.pressure, 1e-11 * largest);
  EXPECT_LE(at_nodes, 1e-11 * speed);
  EXPECT_LE(in_elements, 1e-11 * largest);
  EXPECT_GT(column.inflow().next_id, c.liquid_points.size() + 1000);
  ASSERT_EQ(column.crossed.size(), plain.crossed.size());
  for (const auto& [regions, mass] : plain.crossed) {
    EXPECT_NEAR(column.crossed[regions], mass, 1e-12 * mass);
  }
  EXPECT_GE(plain.crossed.size(), 5U);
}

TEST(CarriedPoints, ThreadsChangeNoBit) {
  const Case<2> c = fast_column(20);
  Column one(c, 1);
  Column two(c, 3);
  for (int k = 0; k < 60; ++k) {
    one.move();
    two.move();
  }
  const LiquidPoints<2> a = one.points();
  const LiquidPoints<2> b = two.points();
  EXPECT_GT(one.count, 1000);
  EXPECT_EQ(a.element, b.element);
  EXPECT_EQ(a.barycentric, b.barycentric);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.water_mass, b.water_mass);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(one.flow().pressure(), two.flow().pressure());
}

TEST(CarriedPoints, NothingIsLostAndNothingComesFromNowhere) {
  const Case<2> c = fast_column(6);
  Column column(c);
  const auto sum = [](const std::vector<double>& values) {
    ExactSum total;
    for (const double v : values) total.add(v);
    return total.value();
  };
  const LiquidPoints<2> before = column.points();
  for (int k = 0; k < 1200; ++k) column.move();
  const LiquidPoints<2> after = column.points();
  double water_in = 0.0;
  for (const auto& [regions, mass] : column.crossed) {
    if (regions.first < 0) water_in += mass;
    if (regions.second < 0) water_in -= mass;
  }
  const double water = sum(before.water_mass);
  const double fines = sum(before.fines_mass);
  std::cout << column.inflow().next_id - before.size() << " points injected: water off by "
            << (sum(after.water_mass) - water - water_in) / water << ", fines by "
            << (sum(after.fines_mass) - fines - column.fines_in.value()) / fines << "\n";
  EXPECT_NEAR(sum(after.water_mass), water + water_in, 1e-12 * water);
  EXPECT_NEAR(sum(after.fines_mass), fines + column.fines_in.value(), 1e-12 * fines);
  EXPECT_GT(column.inflow().next_id, 3L * before.size()) << "the liquid was replaced";
  for (int p = 0; p < after.size(); ++p) {
    for (const double at : after.barycentric[p]) {
      ASSERT_GE(at, -1e-15);
      ASSERT_LE(at, 1.0);
    }
  }
}

/// Points that differ in everything they carry.
LiquidPoints<2> some_points(const std::vector<int>& elements) {
  LiquidPoints<2> points;
  for (const int e : elements) {
    const int p = points.size();
    points.element.push_back(e);
    points.barycentric.push_back({0.125, 0.25, 0.625});
    points.water_mass.push_back(p + 0.1);
    points.fines_mass.push_back(p + 0.2);
    points.id.push_back(100 + p);
    points.pressure.push_back(p + 0.3);
    points.velocity.emplace_back(p + 0.4, p + 0.5);
  }
  return points;
}

TEST(PointBlocks, KeepPointsWholeAndInOrder) {
  const LiquidPoints<2> points = some_points({0, 0, 0, 0, 0, 2, 2, 3});
  PointBlocks<2> blocks;
  blocks.fill(points, 5);
  const LiquidPoints<2> out = blocks.points();
  EXPECT_EQ(out.element, points.element);
  EXPECT_EQ(out.barycentric, points.barycentric);
  EXPECT_EQ(out.water_mass, points.water_mass);
  EXPECT_EQ(out.fines_mass, points.fines_mass);
  EXPECT_EQ(out.id, points.id);
  EXPECT_EQ(out.pressure, points.pressure);
  EXPECT_EQ(out.velocity, points.velocity);
}

TEST(PointBlocks, ALastPointTakesTheSlotOfOneThatLeaves) {
  PointBlocks<2> blocks;
  blocks.fill(some_points({0, 0, 0, 1}), 2);
  const CarriedPoint<2> gone = blocks.remove(0, 0);
  EXPECT_EQ(gone.id, 100);
  EXPECT_EQ(gone.velocity, Vector<2>(0.4, 0.5));
  EXPECT_EQ(blocks.points().id, (std::vector<long>{102, 101, 103}));
}

TEST(PointBlocks, TakeInAsManyPointsAsCome) {
  PointBlocks<2> blocks;
  blocks.fill(some_points({0, 1, 2}), 3);
  CarriedPoint<2> more = blocks.of(0)[0];
  std::vector<long> expected{100};
  for (int k = 0; k < 40; ++k) {
    more.id = 200 + k;
    blocks.add(0, more);
    expected.push_back(more.id);
  }
  more.id = 300;
  blocks.add(1, more);
  expected.insert(expected.end(), {101, 300, 102});
  EXPECT_EQ(blocks.points().id, expected);
  EXPECT_EQ(blocks.count(0), 41);
  EXPECT_EQ(blocks.size(), 44);
}

}  // namespace carried_points_test
}  // namespace suffuse
