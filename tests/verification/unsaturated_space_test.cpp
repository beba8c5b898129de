/// A levee of dry sand in three dimensions, solved by Newton's method with multigrid, compared with
/// its plane section, which uses a direct factor.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "box_mesh.hpp"
#include "driver/plan.hpp"
#include "formulation/single_point.hpp"
#include "solver/model_case.hpp"

namespace suffuse {
namespace unsaturated_space_test {

constexpr double end = 6e4;     // s
constexpr double along = 1.0;   // m of the levee
constexpr double height = 2.0;  // m
constexpr int columns = 24;
constexpr int rows = 12;

/// Crest 1 m, slopes 1:2; `x` is in the unit interval.
double across(double x, double z) {
  return std::lerp(2.0 * z, 9.0 - 2.0 * z, x);
}

template <int Dim>
Mesh<Dim> levee() {
  if constexpr (Dim == 2) {
    return model::column_mesh(columns, rows, 1.0, height, [](const Vector<2>& x) {
      return Vector<2>(across(x[0], x[1]), x[1]);
    });
  } else {
    return model::box_mesh({columns, 3, rows}, {1.0, along, height}, [](const Vector<3>& x) {
      return Vector<3>(across(x[0], x[2]), x[1], x[2]);
    });
  }
}

/// A flood on the left that rises in the first half of the time.
template <int Dim>
Scene scene_of(double alpha, double n) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = end;
  scene.time.tolerance = 1e-3;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.gravity = {0.0, 0.0, 0.0};
  scene.gravity[Dim - 1] = -9.81;
  scene.water_level = -3.0;
  scene.soils[0].conductivity = 1e-4;
  scene.soils[0].retention = model::van_genuchten(alpha, n, 0.05);
  BoundaryCondition flood;
  flood.on = "left";
  flood.head = TimeFunction({{0.0, -1.0}, {0.5 * end, 1.6}, {end, 1.6}});
  flood.concentration = 0.0;
  BoundaryCondition landside;
  landside.on = "right";
  landside.seepage_face = true;
  scene.boundaries = {flood, landside};
  return scene;
}

/// Results per metre of levee.
struct Flood {
  double entered = 0.0;     ///< m3/m
  double stored = 0.0;      ///< m3/m
  double left = 0.0;        ///< m3/m
  double discharge = 0.0;   ///< through the landside, at the end, m2/s
  double systems = 0.0;     ///< solved, per step
  double iterations = 0.0;  ///< per system
  double worst_residual = 0.0;
};

template <int Dim>
Flood run(double alpha, double n) {
  const Case<Dim> c = model::make_case(levee<Dim>(), scene_of<Dim>(alpha, n));
  const Plan plan = make_plan(c, {});
  SinglePoint<Dim> model(c, plan);
  const double width = Dim == 2 ? 1.0 : along;
  const double water = model.ledger().water;
  Flood result;
  while (model.time() < end) {
    model.advance(end);
    const LedgerRow row = model.ledger();
    result.worst_residual = std::max(
        {result.worst_residual, std::abs(row.residual_water), std::abs(row.residual_grains)});
  }
  const auto boundaries = model.boundary_rows(model.flow_state());
  result.entered = (boundaries[0].liquid_in - boundaries[0].liquid_out) / width;
  result.left = (boundaries[1].liquid_out - boundaries[1].liquid_in) / width;
  result.discharge = boundaries[1].discharge / width;
  result.stored = (model.ledger().water - water) / c.document.scene.liquid.density / width;
  const auto count = [&](const std::string& name) {
    for (const PassTiming& pass : model.passes()) {
      if (pass.name == name) return static_cast<double>(pass.calls);
    }
    return 0.0;
  };
  result.systems = count("flow, systems solved") / static_cast<double>(model.steps());
  result.iterations = count("flow, conjugate gradients") / count("flow, systems solved");
  std::cout << Dim << "D, alpha " << alpha << " 1/m, n " << n << ": " << model.steps() << " steps, "
            << count("flow, rejected steps") << " rejected, " << result.systems
            << " systems a step, " << result.iterations << " iterations a system, entered "
            << result.entered << ", stored " << result.stored << ", left " << result.left
            << " m3/m, discharge " << result.discharge << " m2/s, residual "
            << result.worst_residual << '\n';
  return result;
}

class UnsaturatedLevee : public testing::TestWithParam<std::array<double, 2>> {};

TEST_P(UnsaturatedLevee, InSpaceIsLikeItsSection) {
  const auto [alpha, n] = GetParam();
  const Flood space = run<3>(alpha, n);
  const Flood section = run<2>(alpha, n);
  EXPECT_LE(space.worst_residual, 1e-12);
  EXPECT_NEAR(space.entered, space.stored + space.left, 1e-12 * space.entered);
  EXPECT_EQ(space.left > 0.0, section.left > 0.0);
  EXPECT_NEAR(space.entered, section.entered, 0.03 * section.entered);
  EXPECT_NEAR(space.stored, section.stored, 0.03 * section.stored);
  EXPECT_NEAR(space.discharge, section.discharge, 0.05 * section.discharge);
  EXPECT_LE(space.systems, 15.0);
  EXPECT_LE(space.iterations, 8.0);
}

INSTANTIATE_TEST_SUITE_P(Retention, UnsaturatedLevee,
                         testing::Values(std::array{1.0, 1.5}, std::array{15.0, 2.7}),
                         [](const auto& tested) { return tested.index == 0 ? "Mild" : "Steep"; });

}  // namespace unsaturated_space_test
}  // namespace suffuse
