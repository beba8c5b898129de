/// Erosion in unsaturated soil through which water seeps by its weight alone: the gradient is 1
/// everywhere and k_r = |q|/k, for any retention law.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "model_run.hpp"

namespace suffuse {
namespace unsaturated_erosion_test {

constexpr double conductivity = 1e-4;
constexpr double porosity = 0.4;

/// D: porosity gained in a second at |q| = share k, divided by the rate.
double drive_in_seepage(const DriveLaw& drive, double share) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.gravity = {0.0, -9.81, 0.0};
  Soil& soil = scene.soils[0];
  soil.porosity = porosity;
  soil.skeleton_fraction = 0.5;
  soil.conductivity = conductivity;
  soil.retention = model::gardner(2.0, 0.05);
  soil.erosion.law = erosion_law("constant");
  soil.erosion.drive = &drive;
  // Total eroded volume: opening pores draw in water, far less than the flow.
  constexpr double little = 1e-10;
  const double size = std::map<std::string_view, double>{
      {"time", 1.0},
      {"flux", share * conductivity},
      {"gradient", share},
      {"shear-stress", share},
      {"power",
       share * share}}.at(drive.word);
  soil.erosion.rate = little / size;
  scene.initial_flow = InitialFlow::steady;
  scene.time.end = 1.0;
  const double suction = std::log(share) / 2.0 * 9810.0;
  scene.boundaries = {model::flux_on("top", share * conductivity),
                      model::pressure_on("bottom", suction)};
  model::ModelRun run(model::make_case(model::column_mesh(1, 8, 0.125, 1.0), scene));
  const auto moments = run.run({1.0});
  double sum = 0.0;
  for (const double n : moments.states.back().porosity) sum += n - porosity;
  return sum / static_cast<double>(moments.states.back().porosity.size()) / soil.erosion.rate;
}

/// The drives for a flux |q| = k_r k under the gradient 1, of which only the share k_r counts: they
/// are those of the same flux in saturated soil, so they fall as the soil becomes drier.
TEST(UnsaturatedErosion, GoesWithTheWaterThatFlows) {
  const double kappa = conductivity * 1e-3 / 9810.0;
  for (const double share : {0.5, 0.1, 1e-3}) {
    const double flux = share * conductivity;
    const std::map<std::string_view, double> expected{
        {"time", 1.0},
        {"flux", flux},
        {"gradient", share},
        {"shear-stress", 9810.0 * share * std::sqrt(2.0 * kappa / porosity)},
        {"power", 9810.0 * share * flux}};
    for (const DriveLaw* drive : drive_laws()) {
      ASSERT_TRUE(expected.contains(drive->word)) << drive->word;
      EXPECT_NEAR(drive_in_seepage(*drive, share) / expected.at(drive->word), 1.0, 1e-5)
          << drive->word << " at k_r = " << share;
    }
  }
}

}  // namespace unsaturated_erosion_test
}  // namespace suffuse
