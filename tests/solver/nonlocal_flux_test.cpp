/// The flux that erosion laws with a length see, against closed forms.

#include "solid/nonlocal_flux.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "field/channel_width.hpp"
#include "solid/rigid_skeleton.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace nonlocal_flux_test {

// A strip of |x - 1/2| < b carries the flux q1 and has the share w1 of its fines; the soil around
// it carries q0 and has all of them.
constexpr double half_width = 0.125;
constexpr double length = 0.08;
constexpr double q0 = 1e-3;
constexpr double q1 = 4e-3;

Scene scene_with_length(double l) {
  Scene scene = model::paper_scene();
  ErosionSettings& erosion = scene.soils.front().erosion;
  erosion.law = erosion_law("first-order");
  erosion.drive = drive_law("flux");
  erosion.rate = 1.0;
  erosion.length = l;
  return scene;
}

/// The solution of S - l^2 S'' = 1 within the strip and 0 outside, without flux at x = 0 and 1.
double strip(double x) {
  const double r = std::abs(x - 0.5);
  const double end = 0.5;
  if (r < half_width) {
    return 1.0 -
           std::sinh((end - half_width) / length) * std::cosh(r / length) / std::sinh(end / length);
  }
  return std::sinh(half_width / length) * std::cosh((end - r) / length) / std::sinh(end / length);
}

struct Soil2 {
  explicit Soil2(int cells, double l = length, double uneven = 0.0)
      : c(model::make_case(
            model::column_mesh(cells, cells, 1.0, 1.0, model::jittered(uneven / cells, 1)),
            scene_with_length(l))),
        grid(c.mesh),
        soils(c),
        smoothing(grid, soils, 1) {}

  /// Per point: `inside` in the strip, `outside` elsewhere.
  [[nodiscard]] std::vector<double> in_strip(double inside, double outside) const {
    std::vector<double> values;
    for (int p = 0; p < soils.points().size(); ++p) {
      const double x = element_centroid(c.mesh, soils.points().element[p])[0];
      values.push_back(std::abs(x - 0.5) < half_width ? inside : outside);
    }
    return values;
  }

  Case<2> c;
  Grid<2> grid;
  SoilMap<2> soils;
  NonlocalFlux<2> smoothing;
};

/// Root of the mean square of the error at the points, over q0.
double error(int cells, double w1) {
  Soil2 soil(cells);
  PointFlows flows;
  flows.flux = soil.in_strip(q1, q0);
  soil.smoothing.find(soil.in_strip(w1, 1.0), flows);
  double sum = 0.0;
  const MaterialPoints<2>& points = soil.soils.points();
  for (int p = 0; p < points.size(); ++p) {
    const double s = strip(points.position(soil.c.mesh, p)[0]);
    const double exact = (q0 + (w1 * q1 - q0) * s) / (1.0 - (1.0 - w1) * s);
    sum += points.volume[p] * std::pow(flows.eroding_flux[p] - exact, 2);
  }
  return std::sqrt(sum) / q0;
}

TEST(NonlocalFlux, OfAStripConvergesToItsClosedForm) {
  for (const double w1 : {1.0, 0.3, 0.05}) {
    const std::array<double, 3> errors{error(16, w1), error(32, w1), error(64, w1)};
    std::cout << "w1 = " << w1 << ": " << errors[0] << ' ' << errors[1] << ' ' << errors[2] << '\n';
    EXPECT_LT(errors[2], 5e-3);
    EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
  }
}

/// A strip without fines does not count, whatever flows through it.
TEST(NonlocalFlux, OfSoilBesideAChannelIsThatOfTheSoil) {
  Soil2 soil(64);
  PointFlows flows;
  flows.flux = soil.in_strip(100.0 * q0, q0);
  flows.flux_change = soil.in_strip(50.0 * q0, 0.1 * q0);
  const std::vector<double> fines_left = soil.in_strip(0.0, 1.0);
  soil.smoothing.find(fines_left, flows);
  for (std::size_t p = 0; p < fines_left.size(); ++p) {
    if (fines_left[p] == 0.0) continue;
    EXPECT_NEAR(flows.eroding_flux[p], q0, 1e-3 * q0);
    EXPECT_EQ(flows.flux_change[p], 0.0);
  }
}

/// Deep in a channel, where the fines around count for nothing, the flux is that of the place.
TEST(NonlocalFlux, WithoutFinesAroundIsThatOfThePlace) {
  Soil2 soil(32, 0.01);
  PointFlows flows;
  flows.flux = soil.in_strip(q1, q0);
  soil.smoothing.find(soil.in_strip(0.0, 1.0), flows);
  const MaterialPoints<2>& points = soil.soils.points();
  for (int p = 0; p < points.size(); ++p) {
    if (std::abs(points.position(soil.c.mesh, p)[0] - 0.5) > 0.02) continue;
    EXPECT_NEAR(flows.eroding_flux[p], q1, 1e-6 * q1);
  }
}

/// A weighted mean of an even flux is this flux, on any mesh and for any fines.
TEST(NonlocalFlux, OfAnEvenFluxIsThisFlux) {
  for (const double l : {0.01, 0.1, 10.0}) {
    Soil2 soil(12, l, 0.3);
    PointFlows flows;
    flows.flux.assign(soil.soils.points().size(), q0);
    std::vector<double> fines_left;
    for (std::size_t p = 0; p < flows.flux.size(); ++p) {
      fines_left.push_back(0.5 + 0.5 * std::sin(static_cast<double>(p)));
    }
    soil.smoothing.find(fines_left, flows);
    for (const double flux : flows.eroding_flux) EXPECT_NEAR(flux, q0, 1e-10 * q0);
  }
}

/// Fines that leave a strip and its surroundings until their sum has halved, over all, if the
/// intervals are this number.
double lost_in(int intervals) {
  Soil2 soil(16);
  RigidSkeleton<2> solid(soil.grid, soil.soils, {0.0, 1000.0}, 1);
  const std::vector<double> before = solid.state().erodible_volume;
  PointFlows flows;
  std::vector<double> exchange;
  const double interval = 400.0 / intervals;
  for (int i = 0; i < intervals; ++i) {
    flows.flux = soil.in_strip(q1, q0);
    flows.start = i * interval;
    flows.end = flows.start + interval;
    solid.find_eroding_flux(flows);
    solid.exchange(flows.start, flows.end, flows, {}, exchange);
  }
  const std::vector<double>& after = solid.state().erodible_volume;
  return 1.0 - std::reduce(after.begin(), after.end()) / std::reduce(before.begin(), before.end());
}

/// The fines around a place leave during an interval, which changes the flux that erosion sees.
TEST(NonlocalFlux, FollowsTheFinesToSecondOrderInTime) {
  const double exact = lost_in(160);
  const std::array<double, 3> errors{std::abs(lost_in(5) - exact), std::abs(lost_in(10) - exact),
                                     std::abs(lost_in(20) - exact)};
  std::cout << "lost " << exact << ", errors " << errors[0] << ' ' << errors[1] << ' ' << errors[2]
            << '\n';
  EXPECT_GT(exact, 0.3);
  EXPECT_LT(errors[2], 1e-3 * exact);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
}

/// Width of a channel of `columns` cells without fines, over the size of elements.
std::optional<double> channel_of(int columns, double threshold, double l) {
  constexpr int cells = 16;
  Scene scene = scene_with_length(l);
  scene.soils.front().erosion.threshold = threshold;
  const Case<2> c = model::make_case(model::column_mesh(cells, cells), scene);
  const Grid<2> grid(c.mesh);
  const SoilMap<2> soils(c);
  RigidSkeleton<2> solid(grid, soils, {}, 1);
  SolidState state = solid.state();
  for (int p = 0; p < soils.points().size(); ++p) {
    const double column = element_centroid(c.mesh, soils.points().element[p])[0] * cells - 4.0;
    if (column > 0.0 && column < columns) state.erodible_volume[p] = 0.0;
  }
  solid.start_from(state);
  return relative_channel_width(grid, solid);
}

TEST(ChannelWidth, IsCountedInElements) {
  const double size = 1.52 * std::sqrt(0.5);  // of an element, in cells
  EXPECT_NEAR(channel_of(1, 1e-3, 0.0).value(), 1.0 / size, 1e-9);
  EXPECT_NEAR(channel_of(5, 1e-3, 0.0).value(), 5.0 / size, 1e-9);
  EXPECT_FALSE(channel_of(0, 1e-3, 0.0).has_value());
  // Soil without a threshold, or with a length, is not looked at.
  EXPECT_FALSE(channel_of(1, 0.0, 0.0).has_value());
  EXPECT_FALSE(channel_of(1, 1e-3, 0.1).has_value());
}

}  // namespace nonlocal_flux_test
}  // namespace suffuse
