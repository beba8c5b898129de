/// Soil that conducts differently along and across its bedding: the section is that of an isotropic
/// soil stretched by sqrt(k_across / k_along) along the bedding, of conductivity
/// sqrt(k_along k_across), whatever the direction of the bedding.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include "model_run.hpp"

namespace suffuse {
namespace {

constexpr double along = 1e-3;   // m/s
constexpr double across = 1e-4;  // m/s

/// Discharge of a square under a head on half its top, let out by a quarter of its side; `move`
/// puts the square somewhere.
double discharge(const std::function<Vector<2>(const Vector<2>&)>& move, double k_along,
                 double k_across, double bedding) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.initial_flow = InitialFlow::steady;
  scene.soils[0].conductivity = k_along;
  if (k_across != k_along) {
    scene.soils[0].conductivity_across = k_across;
    scene.soils[0].bedding = bedding;
  }
  scene.boundaries = {model::pressure_on("top", 9810.0), model::pressure_on("right", 0.0)};
  Mesh<2> mesh = model::column_mesh(24, 24);
  std::erase_if(mesh.boundaries[0].faces,
                [&](const auto& face) { return mesh.nodes[face[0]][0] > 0.49; });
  std::erase_if(mesh.boundaries[3].faces,
                [&](const auto& face) { return mesh.nodes[face[0]][1] > 0.24; });
  for (Vector<2>& x : mesh.nodes) x = move(x);
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  const HistoryRow row = run.state().history;
  EXPECT_NEAR(row.flux_in, row.flux_out, 1e-12 * row.flux_in);
  return row.flux_out;
}

/// Turned by `angle` degrees.
Vector<2> turned(const Vector<2>& x, double angle) {
  const double a = angle * std::numbers::pi / 180.0;
  return {std::cos(a) * x[0] - std::sin(a) * x[1], std::sin(a) * x[0] + std::cos(a) * x[1]};
}

TEST(Bedding, IsAStretchedIsotropicSection) {
  const double squeeze = std::sqrt(across / along);
  for (const double angle : {0.0, 30.0, 90.0, -45.0}) {
    // The square itself stays; its bedding rises by the angle.
    const double found = discharge([](const Vector<2>& x) { return x; }, along, across, angle);
    const double isotropic = discharge(
        [&](const Vector<2>& x) {
          const Vector<2> y = turned(x, -angle);
          return Vector<2>(y[0] * squeeze, y[1]);
        },
        std::sqrt(along * across), std::sqrt(along * across), 0.0);
    // The model turned, bedding and all.
    const double rotated =
        discharge([](const Vector<2>& x) { return turned(x, 17.0); }, along, across, angle + 17.0);
    std::cout << "bedding " << angle << " degrees: " << found << " m2/s, off the stretched by "
              << found / isotropic - 1.0 << ", off the rotated by " << found / rotated - 1.0
              << '\n';
    EXPECT_NEAR(found / isotropic, 1.0, 1e-3);
    EXPECT_NEAR(found / rotated, 1.0, 1e-10);
  }
}

}  // namespace
}  // namespace suffuse
