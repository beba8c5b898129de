/// Many pore volumes pass a column that does not erode: the number of points stays, and no element
/// becomes empty.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>

#include "double_point_modes.hpp"
#include "free_mesh.hpp"

namespace suffuse {
namespace double_point_long_test {

constexpr double flux = 0.012;
constexpr double pore_volume_time = 0.3 / flux;  ///< s, for a column one metre high

/// The boundaries are top and bottom; mass scaling has no effect on the steady flow.
Scene still_scene(double end) {
  Scene scene = model::double_point_scene(flux, 0.0);
  for (Soil& soil : scene.soils) soil.erosion = {};
  scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
  scene.time.mass_scaling = 1e4;
  scene.time.end = end;
  return scene;
}

class DoublePointLong : public ::testing::TestWithParam<const char*> {
 protected:
  static Mesh<2> mesh() {
    if (GetParam() == std::string("free")) return model::free_mesh(0.25);
    if (GetParam() == std::string("jittered")) {
      return model::column_mesh(4, 4, 1.0, 1.0, model::jittered(0.05, 3));
    }
    return model::column_mesh(4, 4);
  }
};

TEST_P(DoublePointLong, FortyPoreVolumesLeaveThePointsAsTheyWere) {
  const double end = 40.0 * pore_volume_time;
  model::DoublePointRun run(model::make_double_point_case(mesh(), still_scene(end)));
  const LedgerRow initial = run.model().ledger();
  // The interval does not divide the passage of the column, after which the same points recur.
  const auto times = model::times_up_to(end, 0.37 * pore_volume_time);
  const auto moments = run.run(times);
  const std::size_t quarter = times.size() / 4;
  double worst_number = 0.0;
  double worst_volume = 0.0;
  double worst_defect = 0.0;
  double late_defect = 0.0;
  double empty = 0.0;
  std::array<double, 2> volume{};  // mean over the second and the last quarter
  for (std::size_t k = 0; k < times.size(); ++k) {
    const HistoryRow row = moments.states[k].history;
    const double off = moments.states[k].ledger.water / initial.water - 1.0;
    worst_number = std::max(worst_number, std::abs(row.liquid_points / initial.points - 1.0));
    worst_volume = std::max(worst_volume, std::abs(off));
    if (k / quarter == 1) volume[0] += off / static_cast<double>(quarter);
    if (k / quarter == 3) volume[1] += off / static_cast<double>(quarter);
    worst_defect = std::max(worst_defect, row.volume_defect);
    if (k / quarter >= 3) late_defect = std::max(late_defect, row.volume_defect);
    empty = std::max(empty, row.empty_elements);
  }
  std::cout << GetParam() << ": number of points off by " << 100.0 * worst_number
            << " % at most, their water by " << 100.0 * worst_volume
            << " %, in the mean of the second quarter by " << 100.0 * volume[0]
            << " %, of the last by " << 100.0 * volume[1] << " %; volume defect " << worst_defect
            << ", in the last quarter " << late_defect << "; empty elements " << empty << '\n';
  EXPECT_GT(run.model().ledger().points_out, 35.0 * initial.points);
  // Points are whole: at each of the eight open faces less than one point is pending.
  const bool is_free = GetParam() == std::string("free");
  EXPECT_LE(worst_volume, is_free ? 8.0 / initial.points : 0.01);
  EXPECT_NEAR(volume[0], volume[1], 1e-3);
  // With elements of different sizes points differ in size too, and their number varies more.
  const double jittered_or_free =
      GetParam() == std::string("jittered") ? 0.025 : 8.0 / initial.points;
  EXPECT_LE(worst_number, GetParam() == std::string("regular") ? 0.01 : jittered_or_free);
  EXPECT_EQ(empty, 0.0);
  EXPECT_LE(worst_defect, 1.0);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Meshes, DoublePointLong, ::testing::Values("regular", "jittered", "free"));

/// Positions in ascending order, independent of the order of injection.
std::vector<std::array<double, 2>> positions(const model::ModelState<DoublePoint>& state,
                                             const Mesh<2>& mesh) {
  std::vector<std::array<double, 2>> result;
  for (int p = 0; p < state.liquid.size(); ++p) {
    const Vector<2> x = state.liquid.place(p).position(mesh);
    result.push_back({x[1], x[0]});
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(DoublePointInjection, DoNotDependOnTheStep) {
  for (const Seeding seeding : {Seeding::low_discrepancy, Seeding::random}) {
    std::vector<std::vector<std::array<double, 2>>> seen;
    // All points of the start have left by then.
    const double end = 1.2 * pore_volume_time;
    for (const double step : {0.05, 0.013}) {
      Scene scene = still_scene(end);
      scene.points.seeding = seeding;
      scene.time.step = step;
      model::DoublePointRun run(model::make_double_point_case(model::column_mesh(4, 4), scene));
      const auto moments = run.run({end});
      for (const long id : moments.states[0].liquid.id) {
        EXPECT_GE(id, run.input().liquid_points.size());
      }
      seen.push_back(positions(moments.states[0], run.input().mesh));
    }
    ASSERT_EQ(seen[0].size(), seen[1].size());
    double worst = 0.0;
    for (std::size_t k = 0; k < seen[0].size(); ++k) {
      worst =
          std::max(worst, std::hypot(seen[0][k][0] - seen[1][k][0], seen[0][k][1] - seen[1][k][1]));
    }
    std::cout << "injected points with steps of 0.05 s and 0.013 s: " << seen[0].size()
              << " points, positions differ by " << worst << " m at most\n";
    EXPECT_LE(worst, 1e-9);
  }
}

}  // namespace double_point_long_test
}  // namespace suffuse
