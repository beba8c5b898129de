/// Node pressures of the implicit scheme stay within the pressures at the faces and in the elements
/// around, and keep their order on smooth fields.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

#include "geometry.hpp"
#include "mixed/mixed_flow.hpp"
#include "seeding.hpp"
#include "solver/flow_model.hpp"
#include "test_paths.hpp"
#include "verification/model_run.hpp"

namespace suffuse {
namespace node_pressure_test {

constexpr double pi = std::numbers::pi;

// --- The weir of the examples, with its water applied at once ------------------------------------

Case<2> weir() {
  std::string probes = "output.probe=[";
  for (int i = 1; i < 100; ++i) {
    probes += "{at = [" + std::to_string(0.01 * i) + ", 0.97]}, ";
  }
  Case<2> c;
  c.document = read_scene(test::source_folder() + "/workflows/examples/weir/weir.toml",
                          {"boundary[0].pressure=6.0e3", "time.end=40.0", probes + "]"});
  c.mesh = build_geometry_of<2>(c.document).mesh;
  c.solid_points = seed_solid_points(c.mesh, c.document.scene.points);
  return c;
}

TEST(NodePressures, OfTheWeirAreBetweenThosePrescribed) {
  model::ModelRun run(weir());
  constexpr double round_off = 1e-6;  // Pa
  // At the start faces of the upstream side have 6000 Pa, and all other faces 0.
  for (const double time : {0.0, 1e-6, 2.0, 40.0}) {
    SCOPED_TRACE(time);
    const FlowState<2> flow = run.run({time}).flows.back();
    EXPECT_LT(flow.pressure_overshoot, 1e-10);
    const HistoryRow row = run.state().history;
    EXPECT_GE(row.pressure_min, -round_off);
    EXPECT_LE(row.pressure_max, 6e3 + round_off);
    for (const ProbeRow& probe : run.model().probe_rows(flow)) {
      EXPECT_GE(probe.pressure, -round_off) << probe.x;
      EXPECT_LE(probe.pressure, 6e3 + round_off) << probe.x;
    }
  }
}

// --- A smooth field ------------------------------------------------------------------------------

struct Errors {
  double mean = 0.0;  ///< root mean square
  double largest = 0.0;
};

/// p = cos(2 pi x) cos(3/2 pi y): extremes within the square and at the corners of its walls.
double smooth(const Vector<2>& x) {
  return std::cos(2.0 * pi * x[0]) * std::cos(1.5 * pi * x[1]);
}

template <class Values>
Errors errors_of(const Grid<2>& grid, const Values& pressure) {
  Errors result;
  for (int i = 0; i < grid.mesh.node_count(); ++i) {
    const double error = std::abs(pressure[i] - smooth(grid.mesh.nodes[i]));
    result.mean += grid.node_volume[i] * error * error;
    result.largest = std::max(result.largest, error);
  }
  result.mean = std::sqrt(result.mean);
  return result;
}

/// Node pressures without the limit.
std::vector<double> means_of_fields(const Grid<2>& grid, const MixedFlow<2>& flow,
                                    const std::vector<double>& mean) {
  std::vector<double> result(grid.mesh.node_count(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    for (int k = 0; k < 3; ++k) {
      const int i = grid.mesh.elements[e][k];
      const double vertex = 3.0 * mean[e] - 2.0 * flow.state.face_pressure[grid.element_face[e][k]];
      result[i] += grid.volume[e] / 3.0 / grid.node_volume[i] * vertex;
    }
  }
  return result;
}

/// Errors with and without the limit.
std::array<Errors, 2> errors_on(int cells) {
  model::FlowModel m(model::column_mesh(cells, cells, 1.0, 1.0, model::jittered(0.2 / cells, 5)));
  m.set("top", FaceKind::pressure, 0.0);
  const double mobility = 0.02 / (1000.0 * conductivity_gravity);
  for (int e = 0; e < m.mesh.element_count(); ++e) {
    m.forcing.source.push_back(m.grid.volume[e] * mobility * pi * pi * (4.0 + 2.25) *
                               smooth(element_centroid(m.mesh, e)));
  }
  ImplicitMixed<2> scheme(m.grid, {}, Vector<2>::Zero());
  const MixedFlow<2> flow = end_of(scheme.steady(m.forcing));
  const std::vector<double> mean = element_pressure(m.grid, flow.state.face_pressure, 1);
  const NodalFields<2> nodes =
      nodal_fields(m.grid, flow, mean, m.forcing.coefficients.porosity, Vector<2>(0.0, 0.0));
  return {errors_of(m.grid, nodes.pressure),
          errors_of(m.grid, means_of_fields(m.grid, flow, mean))};
}

TEST(NodePressures, OfASmoothFieldAreOfSecondOrder) {
  std::array<Errors, 2> coarse = errors_on(16);
  for (const int cells : {32, 64}) {
    const std::array<Errors, 2> fine = errors_on(cells);
    for (const int i : {0, 1}) {
      const double mean = std::log2(coarse[i].mean / fine[i].mean);
      const double largest = std::log2(coarse[i].largest / fine[i].largest);
      std::cout << cells << (i == 0 ? " limited:   " : " unlimited: ") << fine[i].mean << " (order "
                << mean << "), largest " << fine[i].largest << " (order " << largest << ")\n";
      EXPECT_GT(mean, 1.9);
      EXPECT_GT(largest, 1.7);
    }
    EXPECT_LT(fine[0].mean, 2.0 * fine[1].mean) << "what the limit costs";
    coarse = fine;
  }
}

}  // namespace node_pressure_test
}  // namespace suffuse
