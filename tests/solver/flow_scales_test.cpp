/// Scales of the implicit flow and values read from its state, against known flows.

#include "flow/flow_scales.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mixed/mixed_flow.hpp"
#include "solver/flow_model.hpp"

namespace suffuse {
namespace flow_scales_test {

using model::FlowModel;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double gradient = 6e3 / (1000.0 * conductivity_gravity);  // of 6 kPa over one metre

/// The scales of a column of soil of 0.02 m/s, four by four cells, under these conditions.
FlowScales scales_of(const std::vector<BoundaryCondition>& boundaries) {
  FlowModel m(model::column_mesh(4, 4));
  Scene scene = model::paper_scene();
  scene.boundaries = boundaries;
  const Case<2> c = model::make_case(m.mesh, scene);
  const BoundaryValues<2> values(c, m.grid);
  m.forcing.conditions = values.at(0.0);
  ImplicitMixed<2> scheme(m.grid, {}, Vector<2>::Zero());
  return find_scales(m.grid, scheme, m.forcing, values, scene.time.end, false);
}

TEST(FlowScales, AreThoseOfTheSteadyFlow) {
  const FlowScales scales =
      scales_of({model::pressure_on("top", 6e3), model::pressure_on("bottom", 0.0)});
  EXPECT_NEAR(scales.flux, 0.02 * gradient * 0.25, 1e-12);
  EXPECT_NEAR(scales.pressure, 6e3, 1e-9);
  EXPECT_TRUE(scales.has_bounds);
  EXPECT_EQ(scales.overshoot(Ranks(), {0.0, 5.0, 6e3}), 0.0);
  EXPECT_NEAR(scales.overshoot(Ranks(), {0.0, 5.0, 6.3e3}), 0.05, 1e-12);
  EXPECT_NEAR(scales.overshoot(Ranks(), {-600.0, 5.0, 6.3e3}), 0.1, 1e-12);
}

TEST(FlowScales, SeeBoundaryValuesToCome) {
  BoundaryCondition top = model::pressure_on("top", 0.0);
  top.pressure = TimeFunction({{0.0, 0.0}, {20.0, 6e3}, {40.0, 0.0}});
  const FlowScales scales = scales_of({top, model::pressure_on("bottom", 0.0)});
  EXPECT_NEAR(scales.flux, 0.02 * gradient * 0.25, 1e-12);
  EXPECT_NEAR(scales.pressure, 6e3, 1e-9);
}

TEST(FlowScales, PrescribedFluxesLeavePressuresWithoutBounds) {
  const FlowScales scales =
      scales_of({model::flux_on("top", 0.012), model::pressure_on("bottom", 0.0)});
  EXPECT_NEAR(scales.flux, 0.012 * 0.25, 1e-12);
  EXPECT_FALSE(scales.has_bounds);
  EXPECT_EQ(scales.overshoot(Ranks(), {-1e9, 1e9}), 0.0);
}

TEST(FlowScales, FluxesWithoutASteadyFlowLeaveThemToTheFlow) {
  FlowScales scales = scales_of({model::flux_on("top", 0.012)});
  EXPECT_EQ(scales.flux, 0.0);
  const FlowModel m(model::column_mesh(4, 4));
  raise_over_round_off(scales, m.grid, m.forcing.coefficients, {1000.0, 2e7, 1e-3}, 120.0);
  EXPECT_FALSE(scales.flux_known);
  EXPECT_GT(scales.flux, 0.0);
  EXPECT_LE(scales.flux, 1e-9);
  EXPECT_NEAR(scales.pressure, 2e-5, 1e-12);
  std::vector<double> pressure(m.grid.face_count(), 0.0);
  pressure.back() = 100.0;
  scales.include(m.grid, pressure, std::vector<double>(m.grid.face_count(), 0.003));
  EXPECT_EQ(scales.flux, 0.003);
  EXPECT_EQ(scales.pressure, 100.0);
}

/// The saturated flow that sets the scales may not exist although the run does.
TEST(FlowScales, SoilThatDrainsDoesSoStillWhereNoSteadyFlowExists) {
  FlowModel m(model::column_mesh(2, 4));
  Scene scene = model::paper_scene();
  scene.boundaries = {model::flux_on("top", 0.012)};
  const BoundaryValues<2> values(model::make_case(m.mesh, scene), m.grid);
  m.forcing.conditions = values.at(0.0);
  FlowSoils<2> soils;
  soils.retention.assign(m.mesh.elements.size(), model::gardner(1.0));
  soils.head_per_pressure = 1.0 / (1000.0 * conductivity_gravity);
  ImplicitMixed<2> scheme(m.grid, {}, Vector<2>::Zero(), soils);
  EXPECT_EQ(find_scales(m.grid, scheme, m.forcing, values, scene.time.end, false).flux, 0.0);
  EXPECT_TRUE(scheme.has_retention());
}

TEST(FlowScales, FastestChangeIsRelaxationOrDiffusionThroughAnElement) {
  const FlowModel coarse(model::column_mesh(4, 4));
  const FlowModel fine(model::column_mesh(8, 8));
  // Drag stops the liquid within k / (n g).
  EXPECT_NEAR(fastest_rate(coarse.grid, coarse.forcing.coefficients, infinite, true),
              0.3 * conductivity_gravity / 0.02, 1e-9);
  EXPECT_EQ(fastest_rate(coarse.grid, coarse.forcing.coefficients, infinite, false), 0.0);
  // Pressure diffuses with k K / (n rho g) over a height of 0.25 / sqrt(2).
  const double rate = fastest_rate(coarse.grid, coarse.forcing.coefficients, 2e7, false);
  const double diffusivity = 0.02 * 2e7 / (0.3 * 1000.0 * conductivity_gravity);
  EXPECT_NEAR(rate / (diffusivity * 2.0 / (0.25 * 0.25)), 1.0, 1e-12);
  EXPECT_NEAR(fastest_rate(fine.grid, fine.forcing.coefficients, 2e7, false) / rate, 4.0, 1e-9);
}

TEST(FlowScales, ObtuseElementsAreCounted) {
  EXPECT_EQ(obtuse_elements(FlowModel(model::column_mesh(4, 4)).grid), 0);
  const FlowModel sheared(model::column_mesh(
      4, 4, 1.0, 1.0, [](const Vector<2>& x) { return Vector<2>(x[0] + 0.5 * x[1], x[1]); }));
  EXPECT_EQ(obtuse_elements(sheared.grid), 32);
}

TEST(MixedFlow, LinearPressuresAndUniformFluxesAreExactAtNodes) {
  const FlowModel m(model::column_mesh(5, 4, 1.0, 1.0, model::jittered(0.04, 3)));
  const Vector<2> slope(3.0, -2.0);
  const auto pressure = [&](const Vector<2>& x) { return 7.0 + slope.dot(x); };
  const Vector<2> velocity(0.3, -0.1);
  MixedFlow<2> flow;
  for (int f = 0; f < m.grid.face_count(); ++f) {
    flow.state.face_pressure.push_back(pressure(m.grid.face_centre(f)));
    flow.face_flux.push_back(0.3 * velocity.dot(m.grid.face_normal[f]));
  }
  const std::vector<double> mean = element_pressure(m.grid, flow.state.face_pressure, 1);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    EXPECT_NEAR(mean[e], pressure(element_centroid(m.mesh, e)), 1e-14 * 10.0);
  }
  const std::vector<double>& porosity = m.forcing.coefficients.porosity;
  const NodalFields<2> nodes = nodal_fields(m.grid, flow, mean, porosity, Vector<2>(0.0, 0.0));
  const NodalFields<2> at_rest = nodal_fields(m.grid, flow, mean, porosity, slope);
  const auto [low, high] = std::ranges::minmax(flow.state.face_pressure);
  int limited = 0;
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    const double exact = pressure(m.mesh.nodes[i]);
    EXPECT_NEAR(at_rest.pressure[i], exact, 1e-13) << "water at rest";
    if (exact >= low && exact <= high) {
      EXPECT_NEAR(nodes.pressure[i], exact, 1e-13);
    } else {
      ++limited;
      EXPECT_GE(nodes.pressure[i], low);
      EXPECT_LE(nodes.pressure[i], high);
    }
    EXPECT_LE((nodes.velocity[i] - velocity).norm(), 1e-14);
  }
  EXPECT_EQ(limited, 2) << "the corners with the smallest and the largest pressure";
}

TEST(MixedFlow, WaterCrossesWithTheDensityOfWhereItComesFrom) {
  const FlowModel m(model::column_mesh(2, 2));
  constexpr double modulus = 2e7;
  const int faces = m.grid.face_count();
  // Elements hold 1e4 Pa at the start and 3e4 Pa at the end, faces outside 5e4 Pa throughout.
  const std::vector<double> start_face(faces, 5e4);
  const std::vector<double> start_element(m.mesh.element_count(), 1e4);
  MixedStep<2> step;
  step.face_volume.assign(faces, 0.0);
  step.end.face_pressure.assign(faces, 3e4);
  for (int f = 0; f < faces; ++f) step.face_volume[f] = f % 2 == 0 ? 0.01 : -0.01;
  const FaceVolumes volumes = face_volumes(m.grid, start_face, start_element, step, modulus, 1);
  EXPECT_EQ(volumes.liquid, step.face_volume);
  for (int f = 0; f < faces; ++f) {
    const bool enters = m.grid.is_outer(f) && f % 2 != 0;
    const double density = std::exp((enters ? 4e4 : 2e4) / modulus);
    EXPECT_NEAR(volumes.density_excess[f], step.face_volume[f] * (density - 1.0), 1e-17) << f;
  }
  const FaceVolumes stiff = face_volumes(m.grid, start_face, start_element, step, infinite, 1);
  EXPECT_EQ(stiff.density_excess, std::vector<double>(faces, 0.0));
}

}  // namespace flow_scales_test
}  // namespace suffuse
