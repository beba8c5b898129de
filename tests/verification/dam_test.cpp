/// Steady seepage through a rectangular dam under gravity, in two dimensions. With Gardner's soil
/// and suction above both water levels the discharge is known exactly; with a seepage face it lies
/// between Charny's, without capillarity, and a bound for the capillary zone.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <map>

#include "model_run.hpp"

namespace suffuse {
namespace dam_test {

constexpr double conductivity = 1e-5;  // m/s
constexpr double length = 2.0;         // m
constexpr double height = 2.0;         // m
constexpr double upstream = 1.5;       // m
constexpr double downstream = 0.5;     // m

BoundaryCondition head_on(const std::string& name, double head, DryPart dry) {
  BoundaryCondition b;
  b.on = name;
  b.head = head;
  b.dry = dry;
  b.concentration = 0.0;
  return b;
}

Scene dam_scene(double alpha, DryPart dry) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.stepping = TimeStepping::monotone;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.gravity = {0.0, -9.81, 0.0};
  scene.initial_flow = InitialFlow::steady;
  scene.soils[0].conductivity = conductivity;
  scene.soils[0].retention = model::gardner(alpha);
  scene.boundaries = {head_on("left", upstream, dry), head_on("right", downstream, dry)};
  return scene;
}

/// Inflow on the left side and outflow on the right side, m2/s.
std::pair<double, double> discharge(model::ModelRun& run) {
  const Grid<2>& grid = run.model().grid();
  const FlowState<2> flow = run.model().flow_state();
  std::pair<double, double> result;
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_outer(f)) continue;
    const double x = grid.face_centre(f)[0];
    if (x < 1e-9) result.first -= flow.face_flux[f];
    if (x > length - 1e-9) result.second += flow.face_flux[f];
  }
  return result;
}

double steady_discharge(const Scene& scene, int cells) {
  model::ModelRun run(model::make_case(model::column_mesh(cells, cells, length, height), scene));
  const auto [in, out] = discharge(run);
  EXPECT_NEAR(in, out, 1e-12 * in);
  return out;
}

/// Integral over the height of the potential of Gardner's soil next to water of level `head`, m3/s.
double integrated_potential(double alpha, double head) {
  return conductivity * (head / alpha + 0.5 * head * head +
                         (1.0 - std::exp(-alpha * (height - head))) / (alpha * alpha));
}

TEST(RectangularDam, WithSuctionLetsThroughTheExactDischarge) {
  for (const double alpha : {0.5, 1.0, 2.0, 5.0}) {
    const double exact =
        (integrated_potential(alpha, upstream) - integrated_potential(alpha, downstream)) / length;
    std::map<int, double> error;
    for (const int cells : {20, 40, 80}) {
      const double found = steady_discharge(dam_scene(alpha, DryPart::suction), cells);
      error[cells] = std::abs(found / exact - 1.0);
    }
    const double order = std::log2(error[40] / error[80]);
    std::cout << "alpha " << alpha << " /m: error " << error[20] << ", " << error[40] << ", "
              << error[80] << ", order " << std::log2(error[20] / error[40]) << ", " << order
              << '\n';
    EXPECT_LT(error[20], 5e-3) << alpha;
    EXPECT_GT(order, 1.8) << alpha;
  }
}

TEST(RectangularDam, WithASeepageFaceLetsThroughCharnysDischarge) {
  const double charny =
      conductivity * (upstream * upstream - downstream * downstream) / (2.0 * length);
  double last = std::numeric_limits<double>::infinity();
  for (const double alpha : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    const double largest = 1.0 + 2.0 / (alpha * (upstream + downstream));
    std::map<int, double> found;
    for (const int cells : {20, 40, 80}) {
      found[cells] = steady_discharge(dam_scene(alpha, DryPart::seepage), cells) / charny;
    }
    std::cout << "alpha " << alpha << " /m: " << found[20] << ", " << found[40] << ", " << found[80]
              << " of Charny's discharge, at most " << largest << '\n';
    EXPECT_GT(found[80], 1.0) << alpha;
    EXPECT_LT(found[80], largest) << alpha;
    EXPECT_LT(found[80], last) << alpha;
    // The end of the seepage face is singular: differences halve with the size of the elements.
    EXPECT_LT(std::abs(found[80] - found[40]), 0.75 * std::abs(found[40] - found[20])) << alpha;
    last = found[80];
  }
  EXPECT_LT(last, 1.02);
}

}  // namespace dam_test
}  // namespace suffuse
