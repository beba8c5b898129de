/// Soil with different conductivities along and across its bedding: the section is equivalent to an
/// isotropic soil stretched by sqrt(k_across / k_along) along the bedding, of conductivity
/// sqrt(k_along k_across), for any direction of the bedding.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <utility>

#include "model_run.hpp"
#include "physics/drag.hpp"

namespace suffuse {
namespace bedding_test {

constexpr double better = 1e-3;  // m/s
constexpr double worse = 1e-4;   // m/s

/// Discharge of a square under a head on half of its top, with an outlet over a quarter of its
/// side; `move` transforms the square.
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

/// `x` rotated by `angle` degrees.
Vector<2> turned(const Vector<2>& x, double angle) {
  const double a = angle * std::numbers::pi / 180.0;
  return {std::cos(a) * x[0] - std::sin(a) * x[1], std::sin(a) * x[0] + std::cos(a) * x[1]};
}

/// Compares soil with the conductivities `along` and `across` its bedding with a stretched section.
void expect_stretched_section(double along, double across) {
  const double squeeze = std::sqrt(across / along);
  for (const double angle : {0.0, 30.0, 90.0, -45.0}) {
    // The square stays; its bedding rises by the angle.
    const double found = discharge([](const Vector<2>& x) { return x; }, along, across, angle);
    const double isotropic = discharge(
        [&](const Vector<2>& x) {
          const Vector<2> y = turned(x, -angle);
          return Vector<2>(y[0] * squeeze, y[1]);
        },
        std::sqrt(along * across), std::sqrt(along * across), 0.0);
    // The model rotated together with its bedding.
    const double rotated =
        discharge([](const Vector<2>& x) { return turned(x, 17.0); }, along, across, angle + 17.0);
    std::cout << "bedding " << angle << " degrees: " << found << " m2/s, off the stretched by "
              << found / isotropic - 1.0 << ", off the rotated by " << found / rotated - 1.0
              << '\n';
    EXPECT_NEAR(found / isotropic, 1.0, 1e-3);
    EXPECT_NEAR(found / rotated, 1.0, 1e-10);
  }
}

TEST(Bedding, IsAStretchedIsotropicSection) {
  expect_stretched_section(better, worse);
}

TEST(Bedding, IsAStretchedIsotropicSectionWhereItConductsBetterAcross) {
  expect_stretched_section(worse, better);
}

TEST(Bedding, HasNoPreferredName) {
  const auto stay = [](const Vector<2>& x) { return x; };
  for (const double angle : {0.0, 25.0, -70.0}) {
    const double across = discharge(stay, worse, better, angle);
    const double along = discharge(stay, better, worse, angle + 90.0);
    EXPECT_NEAR(across / along, 1.0, 1e-10) << angle;
  }
}

/// Flow down a column of height 1 m and width 0.5 m under a head of 1 m.
double column_discharge(double k_along, double k_across, double bedding, bool ergun_above) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.initial_flow = InitialFlow::steady;
  scene.soils[0].conductivity = k_along;
  scene.soils[0].conductivity_across = k_across;
  scene.soils[0].bedding = bedding;
  scene.boundaries = {model::pressure_on("top", 9810.0), model::pressure_on("bottom", 0.0)};
  Mesh<2> mesh = model::column_mesh(3, 8, 0.5);
  if (ergun_above) {
    Soil gravel = scene.soils[0];
    gravel.region = "gravel";
    gravel.conductivity = 1e-2;
    gravel.conductivity_across = unset;
    gravel.drag = SoilDrag::ergun;
    scene.soils.push_back(gravel);
    mesh.region_names.emplace_back("gravel");
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (element_centroid(mesh, e)[1] > 0.5) mesh.element_region[e] = 1;
    }
  }
  model::ModelRun run(model::make_case(std::move(mesh), scene));
  return run.state().history.flux_out;
}

TEST(Bedding, DecidesWhatRunsThroughAColumn) {
  EXPECT_NEAR(column_discharge(worse, better, 0.0, false), 0.5 * better, 1e-12 * better);
  EXPECT_NEAR(column_discharge(worse, better, 90.0, false), 0.5 * worse, 1e-12 * better);
  EXPECT_NEAR(column_discharge(better, worse, 0.0, false), 0.5 * worse, 1e-12 * better);
}

/// Newton's method for quadratic drag keeps the bedding of the soil below the gravel.
TEST(Bedding, StaysBesideSoilWithErgunsDrag) {
  for (const auto& [along, across] : {std::pair{better, worse}, std::pair{worse, better}}) {
    const double flux = column_discharge(along, across, 0.0, true) / 0.5;
    // The head is lost in half a metre of each soil.
    const double size = ergun_grain_size(1e-2, 0.3, 1000.0, 1e-3);
    const double quadratic = ergun_quadratic_drag(0.3, 1000.0, size) / (1000.0 * 9.81);
    const double lost = 0.5 * (flux / across + flux / 1e-2 + quadratic * flux * flux);
    EXPECT_NEAR(lost, 1.0, 1e-9) << across;
  }
}

/// Flux of a column of 1 m that starts from rest, or in its steady state, with the inertia of the
/// liquid, after ten steps.
double flux_with_inertia(double k_along, double k_across, InitialFlow start, double step) {
  Scene scene = model::paper_scene();
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.inertia = true;
  scene.time.step = step;
  scene.time.end = 10.0 * step;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.initial_flow = start;
  scene.soils[0].conductivity = k_along;
  if (k_across != k_along) scene.soils[0].conductivity_across = k_across;
  scene.boundaries = {model::pressure_on("top", 9810.0), model::pressure_on("bottom", 0.0)};
  model::ModelRun run(model::make_case(model::column_mesh(3, 8), scene));
  return run.run({scene.time.end}).states.back().history.flux_out;
}

/// Inertia has no direction: flow across the layers starts as in isotropic soil with their
/// conductivity, and steady flow stays as it is in steps of any length.
TEST(Bedding, LeavesTheInertiaOfTheLiquidAlone) {
  for (const auto& [along, across] : {std::pair{better, worse}, std::pair{worse, better}}) {
    for (const double step : {1e-2, 1e-3, 1e-4}) {
      const double steady = flux_with_inertia(along, across, InitialFlow::steady, step);
      EXPECT_NEAR(steady / across, 1.0, 1e-9) << step;
      const double from_rest = flux_with_inertia(along, across, InitialFlow::rest, step);
      const double isotropic = flux_with_inertia(across, across, InitialFlow::rest, step);
      EXPECT_NEAR(from_rest / isotropic, 1.0, 1e-9) << step;
    }
  }
}

}  // namespace bedding_test
}  // namespace suffuse
