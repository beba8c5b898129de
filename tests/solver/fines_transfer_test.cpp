#include "points/fines_transfer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numeric>

#include "solver/double_point_case.hpp"

namespace suffuse {
namespace fines_transfer_test {

constexpr double grain_density = 2700.0;

/// A square of soil with liquid points, and all that a transfer needs.
struct TransferCase {
  TransferCase(MassTransfer way, Seeding seeding, int points_per_element, double jitter)
      : input(make(way, seeding, points_per_element, jitter)),
        grid(input.mesh),
        soils(input),
        shared(grid),
        transfer(grid, soils, shared, grain_density),
        pending(input.mesh.node_count(), 0.0) {
    const MaterialPoints<2>& seeded = input.liquid_points;
    points.element = seeded.element;
    points.barycentric = seeded.barycentric;
    points.fines_mass.assign(seeded.size(), 0.0);
    for (int p = 0; p < seeded.size(); ++p) {
      points.water_mass.push_back(1000.0 * seeded.volume[p]);
      points.id.push_back(p);
    }
  }
  TransferCase(const TransferCase&) = delete;
  TransferCase& operator=(const TransferCase&) = delete;
  ~TransferCase() = default;

  static Case<2> make(MassTransfer way, Seeding seeding, int points_per_element, double jitter) {
    Scene scene = model::double_point_scene(0.012, 1e-3);
    scene.soils[0].erosion.mass_transfer = way;
    scene.points.seeding = seeding;
    scene.points.liquid_per_element = points_per_element;
    return model::make_double_point_case(
        model::column_mesh(5, 5, 1.0, 1.0, model::jittered(jitter, 6)), std::move(scene));
  }

  /// Removes the points of some elements.
  void empty(const std::function<bool(int)>& without) {
    std::vector<unsigned char> keep;
    for (const int e : points.element) keep.push_back(without(e) ? 0 : 1);
    keep_points(points, keep);
  }
  [[nodiscard]] std::vector<int> begins() const {
    return element_begins(points, input.mesh.element_count());
  }
  [[nodiscard]] std::vector<double> volumes() const {
    std::vector<double> result;
    result.reserve(points.size());
    for (int p = 0; p < points.size(); ++p) {
      result.push_back(
          liquid_volume(points.water_mass[p], points.fines_mass[p], {1000.0, grain_density}, 1.0));
    }
    return result;
  }
  /// Volume that solid points give if their porosity grows by growth(element), m3.
  [[nodiscard]] std::vector<double> exchange(const std::function<double(int)>& growth) const {
    std::vector<double> result = soils.points().volume;
    for (std::size_t s = 0; s < result.size(); ++s) {
      result[s] *= growth(soils.points().element[s]);
    }
    return result;
  }
  /// Points take the eroded fines, as points that carry the flow do.
  auto erode(const std::function<double(int)>& growth) {
    points.pressure.assign(points.size(), 0.0);
    points.velocity.assign(points.size(), Vector<2>::Zero());
    PointBlocks<2> blocks;
    blocks.fill(points, input.mesh.element_count());
    const std::vector<double> porosity(input.mesh.element_count(), 0.3);
    auto result =
        transfer.transfer(exchange(growth), porosity, {1000.0, grain_density}, blocks, pending);
    points = blocks.points();
    return result;
  }
  [[nodiscard]] double fines() const {
    return std::accumulate(points.fines_mass.begin(), points.fines_mass.end(), 0.0);
  }
  [[nodiscard]] double pending_mass() const {
    return grain_density * std::accumulate(pending.begin(), pending.end(), 0.0);
  }
  [[nodiscard]] double volume_of(int e) const { return grid.volume[e]; }

  Case<2> input;
  Grid<2> grid;
  SoilMap<2> soils;
  SharedPoints<2> shared;
  FinesTransfer<2> transfer;
  LiquidPoints<2> points;
  std::vector<double> pending;
};

TEST(FinesTransfer, LosesNothing) {
  for (const MassTransfer way : {MassTransfer::nodal, MassTransfer::element}) {
    for (const int points : {1, 3, 12}) {
      TransferCase c(way, Seeding::random, points, 0.04);
      // Some elements have no points, among them four in a corner.
      c.empty([](int e) { return e % 7 == 3 || e < 4; });
      double eroded = 0.0;
      for (int round = 0; round < 5; ++round) {
        // Some elements do not erode.
        const auto growth = [&](int e) { return (e + round) % 3 == 0 ? 0.0 : 1e-3 * (1 + e % 5); };
        const auto result = c.erode(growth);
        double now = 0.0;
        for (int e = 0; e < c.input.mesh.element_count(); ++e) {
          now += grain_density * c.volume_of(e) * growth(e);
        }
        eroded += now;
        EXPECT_NEAR(result.eroded[0].value(), now, 1e-13);
        EXPECT_NEAR(c.fines() + c.pending_mass(), eroded, 1e-12);
        for (const double mass : c.points.fines_mass) EXPECT_GE(mass, 0.0);
      }
    }
  }
}

TEST(FinesTransfer, ByElementEachPointTakesItsShareOfTheElement) {
  TransferCase c(MassTransfer::element, Seeding::random, 4, 0.04);
  // Points of an element have different volumes.
  for (int p = 0; p < c.points.size(); ++p) c.points.water_mass[p] *= 1.0 + 0.1 * (p % 3);
  const auto growth = [](int e) { return 1e-3 * (e % 5); };
  const std::vector<double> volume = c.volumes();
  c.erode(growth);
  const std::vector<int> begins = c.begins();
  for (int e = 0; e < c.input.mesh.element_count(); ++e) {
    double all = 0.0;
    for (int p = begins[e]; p < begins[e + 1]; ++p) all += volume[p];
    for (int p = begins[e]; p < begins[e + 1]; ++p) {
      const double expected = grain_density * c.volume_of(e) * growth(e) * volume[p] / all;
      EXPECT_NEAR(c.points.fines_mass[p], expected, 1e-15);
    }
  }
}

TEST(FinesTransfer, ByNodesEvenErosionGivesEvenConcentration) {
  // Points represent exactly the pores of their element: each takes phi / n of its volume.
  TransferCase even(MassTransfer::nodal, Seeding::gauss, 3, 0.04);
  const std::vector<double> volume = even.volumes();
  even.erode([](int) { return 1e-3; });
  for (int p = 0; p < even.points.size(); ++p) {
    EXPECT_NEAR(even.points.fines_mass[p] / (grain_density * volume[p]), 1e-3 / 0.3, 1e-15);
  }

  // With random points, the transfer by element is as uneven as the numbers of points; by nodes it
  // is much more even.
  const auto spread = [](MassTransfer way) {
    TransferCase c(way, Seeding::random, 12, 0.04);
    // Keeps a third of the points, unevenly.
    std::vector<unsigned char> keep;
    keep.reserve(c.points.size());
    for (int p = 0; p < c.points.size(); ++p) keep.push_back((p * p + p / 7) % 3 == 0 ? 1 : 0);
    keep_points(c.points, keep);
    const std::vector<double> volumes = c.volumes();
    c.erode([](int) { return 1e-3; });
    double mean = 0.0;
    double square = 0.0;
    for (int p = 0; p < c.points.size(); ++p) {
      const double value = c.points.fines_mass[p] / volumes[p] / c.points.size();
      mean += value;
      square += value * value * c.points.size();
    }
    return std::sqrt(square / (mean * mean) - 1.0);
  };
  const double by_element = spread(MassTransfer::element);
  const double by_nodes = spread(MassTransfer::nodal);
  std::cout << "spread of what points take, uneven numbers: by element " << by_element
            << ", by nodes " << by_nodes << '\n';
  EXPECT_LE(by_nodes, 0.5 * by_element);
}

TEST(FinesTransfer, WaitsForLiquidWhereThereIsNone) {
  for (const MassTransfer way : {MassTransfer::nodal, MassTransfer::element}) {
    TransferCase c(way, Seeding::low_discrepancy, 3, 0.0);
    const LiquidPoints<2> all = c.points;
    c.empty([](int) { return true; });
    c.erode([](int) { return 1e-3; });
    EXPECT_NEAR(c.pending_mass(), grain_density * 1e-3, 1e-13);
    for (const double volume : c.pending) EXPECT_GT(volume, 0.0);
    // Pending fines go to liquid that arrives, without further erosion.
    c.points = all;
    const auto result = c.erode([](int) { return 0.0; });
    EXPECT_NEAR(c.fines(), grain_density * 1e-3, 1e-13);
    EXPECT_EQ(c.pending_mass(), 0.0);
    EXPECT_EQ(result.eroded[0].value(), 0.0);
    EXPECT_NEAR(result.received[0].value(), grain_density * 1e-3, 1e-13);
  }
}

TEST(FinesTransfer, AnEmptyElementGivesToItsNeighbours) {
  for (const MassTransfer way : {MassTransfer::nodal, MassTransfer::element}) {
    TransferCase c(way, Seeding::low_discrepancy, 3, 0.0);
    const int lone = 24;
    c.empty([&](int e) { return e == lone; });
    c.erode([&](int e) { return e == lone ? 1e-3 : 0.0; });
    EXPECT_NEAR(c.fines() + c.pending_mass(), grain_density * 1e-3 * c.volume_of(lone), 1e-15);
    EXPECT_EQ(c.pending_mass(), 0.0);
  }
}

/// Uptakes of points that did not move.
std::vector<FinesUptake<2>> takes_in_place(const TransferCase& c, double growth) {
  std::vector<FinesUptake<2>> takes;
  const std::vector<double> volume = c.volumes();
  takes.reserve(volume.size());
  for (int p = 0; p < c.points.size(); ++p) {
    takes.push_back({p, c.points.element[p], c.points.barycentric[p], volume[p] * growth, 0});
  }
  return takes;
}

TEST(FinesTransfer, AlongPathsEachUptakeGetsItsOwnTimesACommonFactor) {
  // Uptakes add up to half of the eroded fines, evenly, so each is doubled.
  TransferCase c(MassTransfer::nodal, Seeding::gauss, 3, 0.04);
  auto takes = takes_in_place(c, 0.5 * 1e-3 / 0.3);
  const std::vector<double> exchange = c.exchange([](int) { return 1e-3; });
  const auto result =
      c.transfer.transfer_along_paths(exchange, c.volumes(), c.points, takes, c.pending);
  for (const FinesUptake<2>& take : takes) {
    EXPECT_NEAR(take.mass / (grain_density * take.own_volume), 2.0, 1e-12);
    EXPECT_EQ(c.points.fines_mass[take.point], take.mass);
  }
  EXPECT_NEAR(result.received[0].value(), grain_density * 1e-3, 1e-13);
  EXPECT_NEAR(result.eroded[0].value(), grain_density * 1e-3, 1e-13);
}

TEST(FinesTransfer, AlongPathsNothingIsLost) {
  for (const MassTransfer way : {MassTransfer::nodal, MassTransfer::element}) {
    TransferCase c(way, Seeding::random, 3, 0.04);
    c.empty([](int e) { return e % 7 == 3 || e < 4; });
    const auto growth = [](int e) { return e % 3 == 0 ? 0.0 : 1e-3 * (1 + e % 5); };
    // Only some points take up fines, far less than was eroded.
    auto takes = takes_in_place(c, 1e-4);
    std::erase_if(takes, [&](const FinesUptake<2>& take) {
      return take.point % 2 == 0 || growth(take.element) == 0.0;
    });
    const auto result = c.transfer.transfer_along_paths(c.exchange(growth), c.volumes(), c.points,
                                                        takes, c.pending);
    EXPECT_NEAR(c.fines() + c.pending_mass(), result.eroded[0].value(), 1e-13);
    EXPECT_NEAR(c.fines(), result.received[0].value(), 1e-13);
    if (way == MassTransfer::nodal) continue;
    // By element: all fines that it eroded, if a point took up fines there.
    std::vector<double> of_element(c.input.mesh.element_count(), 0.0);
    for (const FinesUptake<2>& take : takes) of_element[take.element] += take.mass;
    for (const FinesUptake<2>& take : takes) {
      const int e = take.element;
      EXPECT_NEAR(of_element[e], grain_density * c.volume_of(e) * growth(e), 1e-14);
    }
  }
}

TEST(FinesTransfer, AlongPathsFinesThatNoPointTookGoToPointsNear) {
  TransferCase c(MassTransfer::nodal, Seeding::low_discrepancy, 3, 0.0);
  const std::vector<double> exchange = c.exchange([](int) { return 1e-3; });
  std::vector<FinesUptake<2>> none;
  c.transfer.transfer_along_paths(exchange, c.volumes(), c.points, none, c.pending);
  EXPECT_NEAR(c.fines(), grain_density * 1e-3, 1e-13);
  EXPECT_EQ(c.pending_mass(), 0.0);

  TransferCase dry(MassTransfer::nodal, Seeding::low_discrepancy, 3, 0.0);
  dry.empty([](int) { return true; });
  dry.transfer.transfer_along_paths(exchange, {}, dry.points, none, dry.pending);
  EXPECT_NEAR(dry.pending_mass(), grain_density * 1e-3, 1e-13);
}

}  // namespace fines_transfer_test
}  // namespace suffuse
