/// Soil between two rigid plates drains to its sides: the pressure in the middle first rises
/// (Mandel 1953).

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "moving_soil.hpp"
#include "reference_table.hpp"

namespace suffuse {
namespace mandel_test {

constexpr double young = 1e7;             // Pa
constexpr double conductivity = 1e-6;     // m/s
constexpr double load = 1e3;              // Pa
constexpr double weight = 1000.0 * 9.81;  // of water, N/m3
constexpr double height = 4.0;            // m; half of the width is 1 m

/// The right upper quarter of a tall body. No key of a scene imposes a rigid and smooth plate. But
/// far from its ends, for any loads on them, a body that is uniform along its height has plane
/// sections, as the plates enforce (Saint-Venant). So the load is uniform, and the pressures are
/// those at mid-height.
class Quarter {
 public:
  Quarter(int columns, double poisson)
      : second_(weight / (conductivity * SkeletonParameters{young, poisson}.oedometer_modulus())),
        run_(model::make_case(model::crossed_mesh(columns, 10, 1.0, height), scene(poisson))) {}

  [[nodiscard]] model::ModelRun& run() { return run_; }
  /// Time of T = 1, s.
  [[nodiscard]] double second() const { return second_; }
  /// Mean pressure of the lowest nodes at a distance from the middle plane, over the first
  /// pressure.
  double pressure(double distance) {
    const double first = 0.5 * load;  // of nearly incompressible water
    return model::mean_pressure(run_,
                                [&](const Vector<2>& x) {
                                  return std::abs(x[0] - distance) < 1e-9 && x[1] < 0.1 * height;
                                }) /
           first;
  }

 private:
  [[nodiscard]] Scene scene(double poisson) const {
    Scene scene = model::paper_scene();
    scene.time.scheme = FlowScheme::implicit_mixed;
    scene.time.tolerance = 5e-4;
    scene.time.end = second_;
    scene.liquid.bulk_modulus = 2e9;
    scene.soils[0].conductivity = conductivity;
    scene.soils[0].skeleton = model::elastic_soil(young, poisson);
    BoundaryCondition side = model::pressure_on("right", 0.0);
    side.concentration = 0.0;
    BoundaryCondition top;
    top.on = "top";
    top.traction = model::sudden_traction({0.0, -load}, scene.time.end);
    scene.boundaries = {side, top, model::fixed_on("left", Fixing::normal),
                        model::fixed_on("bottom", Fixing::normal)};
    return scene;
  }

  double second_;
  model::ModelRun run_;
};

class Mandel : public ::testing::TestWithParam<std::pair<double, double>> {};
INSTANTIATE_TEST_SUITE_P(PoissonsRatios, Mandel,
                         ::testing::Values(std::pair(0.0, 1.15555), std::pair(0.2, 1.10690),
                                           std::pair(0.3, 1.07638)));

TEST_P(Mandel, PressureInTheMiddleFirstRises) {
  const auto [poisson, peak] = GetParam();
  Quarter quarter(16, poisson);
  double worst = 0.0;
  double highest = 0.0;
  double now = 0.0;
  const auto run_to = [&](double T) {
    now = T;
    quarter.run().run({now * quarter.second()});
    highest = std::max(highest, quarter.pressure(0.0));
  };
  for (const ReferenceRow& row : read_reference("mandel.csv")) {
    if (row.number("nu") != poisson) continue;
    const double T = row.number("T");
    // The peak is flat: it is sought at intervals of 0.005.
    while (now + 0.0051 < T && now < 0.15) run_to(now + 0.005);
    run_to(T);
    const double centre = quarter.pressure(0.0) - row.number("p_centre");
    const double half = quarter.pressure(0.5) - row.number("p_half");
    std::cout << "nu " << poisson << ", T " << T << ": centre off by " << centre << ", half way "
              << half << "\n";
    worst = std::max({worst, std::abs(centre), std::abs(half)});
  }
  std::cout << "nu " << poisson << ": peak " << highest << " (" << peak << "), worst " << worst
            << ", " << quarter.run().steps() << " steps, "
            << quarter.run().model().coupled_flow().iterations() << " iterations\n";
  EXPECT_NEAR(highest, peak, 0.01 * peak);
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(quarter.run().worst_residual(), 1e-12);
}

}  // namespace mandel_test
}  // namespace suffuse
