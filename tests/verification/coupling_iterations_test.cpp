/// Number of iterations between flow and motion of the soil in a step, from undrained to drained.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "moving_soil.hpp"

namespace suffuse {
namespace coupling_iterations_test {

constexpr double young = 1e7;             // Pa
constexpr double conductivity = 1e-6;     // m/s
constexpr double weight = 1000.0 * 9.81;  // of water, N/m3
constexpr double load = 1e3;              // Pa
constexpr int steps = 4;

using model::fixed_on;

/// Mean number of iterations in steps of length `T` H2/c_v on a block of `cells` x `cells` crossed
/// cells. It is loaded at its top, where it drains, and free at its right side. Water is
/// incompressible.
double iterations_per_step(int cells, double poisson, double T) {
  const double modulus = SkeletonParameters{young, poisson}.oedometer_modulus();
  const double step = T * weight / (conductivity * modulus);
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.step = step;
  scene.time.end = steps * step;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils[0].conductivity = conductivity;
  scene.soils[0].skeleton = model::elastic_soil(young, poisson);
  BoundaryCondition top = model::pressure_on("top", 0.0);
  top.concentration = 0.0;
  top.traction = model::sudden_traction({0.0, -load}, 1e6 * scene.time.end);
  scene.boundaries = {top, fixed_on("bottom", Fixing::both), fixed_on("left", Fixing::normal)};
  model::ModelRun run(model::make_case(model::crossed_mesh(cells, cells, 1.0, 1.0), scene));
  run.run({scene.time.end});
  // The load is applied in a separate step. No step was rejected.
  EXPECT_LE(run.steps(), steps + 1);
  return static_cast<double>(run.model().coupled_flow().iterations()) /
         static_cast<double>(run.steps());
}

TEST(CouplingIterations, DependOnNeitherMeshNorPoissonNorDrainage) {
  for (const int cells : {16, 50, 160}) {
    for (const double poisson : {0.0, 0.3, 0.49}) {
      std::cout << 4 * cells * cells << " elements, nu " << poisson << ":";
      for (const double T : {1e-8, 1e-4, 1e-2, 1.0, 1e4}) {
        const double iterations = iterations_per_step(cells, poisson, T);
        std::cout << "  T " << T << ": " << iterations << std::flush;
        EXPECT_LE(iterations, 25.0);
      }
      std::cout << "\n";
    }
  }
}

}  // namespace coupling_iterations_test
}  // namespace suffuse
