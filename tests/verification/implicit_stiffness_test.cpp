/// A day in soils from clay to gravel and with waters from soft to incompressible; the length of
/// steps follows the changes, not stability.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "model_run.hpp"

namespace suffuse {
namespace implicit_stiffness_test {

constexpr double stiff = std::numeric_limits<double>::infinity();
constexpr double head = 5886.0;  ///< Pa over one metre: a gradient of 0.6

Scene under_head(double end) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = end;
  scene.boundaries = {model::pressure_on("top", head), model::pressure_on("bottom", 0.0)};
  scene.boundaries[0].concentration = 0.0;
  return scene;
}

TEST(Stiffness, AnySoilAndAnyWaterGetThroughADay) {
  for (const double conductivity : {1e-9, 1e-7, 1e-5, 1e-3, 1e-1}) {
    for (const double modulus : {2e5, 2e7, 2e9, stiff}) {
      // In such a day liquid crosses 70 000 elements; one such run is enough.
      if (conductivity == 1e-1 && modulus != 2e7) continue;
      Scene scene = under_head(86400.0);
      scene.liquid.bulk_modulus = modulus;
      scene.output.every = scene.output.snapshot_every = 3600.0;
      scene.soils[0].conductivity = conductivity;
      scene.soils[0].erosion = {erosion_law("first-order"), 1e-4, 600.0, false};
      model::ModelRun run(model::make_case(model::column_mesh(4, 4), scene));
      const auto moments = run.run({86400.0});
      const HistoryRow row = moments.states[0].history;
      std::cout << "k = " << conductivity << ", K = " << modulus << ": " << run.steps()
                << " steps, residual " << run.worst_residual() << '\n';
      EXPECT_LE(run.worst_residual(), 1e-12);
      EXPECT_GE(row.concentration_min, 0.0);
      EXPECT_LT(row.concentration_max, 1.0);
      for (const double n : moments.states[0].porosity) {
        EXPECT_NEAR(n, 0.4 - 0.1 * std::exp(-1e-4 * 85800.0), 1e-11);
      }
      // After the diffusion of pressure, of the time L^2 rho g n / (K k), the flux is Darcy's.
      // Water that expands by p / K on its way flows faster further down by that share.
      const double settling = 1000.0 * 9.81 * 0.3 / (modulus * conductivity);
      if (settling < 1e3) {
        std::cout << "  flux over Darcy's: " << row.flux_in / (conductivity * 0.6) << '\n';
        EXPECT_NEAR(row.flux_in / (conductivity * 0.6), 1.0, head / modulus + 1e-6);
      }
    }
  }
}

}  // namespace implicit_stiffness_test
}  // namespace suffuse
