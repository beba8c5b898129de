/// Along any path of length s through soil that only catches fines, the ratio of fines to water is
/// proportional to exp(-lambda s): in radial flow and under a weir, along streamlines to the
/// outlet, whose lengths follow from walks against the flow.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>

#include "grid/face_walk.hpp"
#include "model_run.hpp"

namespace suffuse {
namespace filter_paths_test {

constexpr double lambda = 2.0;
constexpr double entering = 1e-4;  // so small that pores stay as they are

Scene filter_scene(Formulation formulation, double end) {
  Scene scene = model::paper_scene();
  scene.formulation = formulation;
  scene.liquid.bulk_modulus = std::numeric_limits<double>::infinity();
  scene.soils[0].deposition.coefficient = lambda;
  scene.initial_flow = InitialFlow::steady;
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = scene.output.every = scene.output.snapshot_every = end;
  return scene;
}

BoundaryCondition inlet_on(const std::string& name) {
  BoundaryCondition inlet = model::pressure_on(name, 9810.0);
  inlet.concentration = entering;
  return inlet;
}

/// A quarter of a ring, radii 0.2 and 1 m, with its outer boundary on top.
Mesh<2> ring(int cells) {
  return model::column_mesh(20, cells, 1.0, 1.0, [](const Vector<2>& x) {
    const double angle = 0.5 * std::numbers::pi * (1.0 - x[0]);
    const double radius = 0.2 + 0.8 * x[1];
    return Vector<2>(radius * std::cos(angle), radius * std::sin(angle));
  });
}

/// A place on an outer face, at a share of its length from one end.
PointPlace<2> place_on(const Grid<2>& grid, int face, double share) {
  const int e = grid.face_left[face];
  PointPlace<2> place{e, {}};
  double next = share;
  for (int k = 0; k < 3; ++k) {
    if (grid.element_face[e][k] == face) continue;
    place.barycentric[k] = next;
    next = 1.0 - share;
  }
  return place;
}

/// Ratio of fines to water, by volume, at a place.
double fines_at(const FinesState<2>& state, const PointPlace<2>& place) {
  const int e = place.element;
  ElementValues<2> c;
  for (int j = 0; j < 3; ++j) c[j] = state.fines_volume[e][j] / state.liquid_volume[e][j];
  const double value = FieldNodes<2>::value(c, place.barycentric);
  return value / (1.0 - value);
}

/// Length of the path that ends at a place.
double length_to(const Grid<2>& grid, const std::vector<double>& face_flux, PointPlace<2> place) {
  std::vector<double> backwards = face_flux;
  for (double& flux : backwards) flux *= -1e6;  // longer than any path takes
  const std::vector<double> porosity(grid.mesh.elements.size(), 0.3);
  const FaceWalkField<2> field{backwards, porosity, porosity, true};
  std::vector<FacePassage<2>> passages;
  EXPECT_GE(walk_along_faces(grid, field, place, 0.0, 1.0, 0, passages), 0);
  double length = 0.0;
  for (const FacePassage<2>& passage : passages) length += passage.path;
  return length;
}

/// Largest relative error at the outlet, over two streamlines from each of its faces for which
/// `counts` holds; the lengths of the streamlines are stored in `lengths`.
double worst_at_outlet(model::ModelRun& run, double end,
                       const std::function<bool(const Vector<2>&)>& counts,
                       std::vector<double>& lengths) {
  const auto moments = run.run({end});
  const Grid<2>& grid = run.model().grid();
  const std::vector<double>& flux = moments.flows[0].face_flux;
  double worst = 0.0;
  for (int f = 0; f < grid.face_count(); ++f) {
    if (!grid.is_outer(f) || flux[f] < 1e-9 || !counts(grid.face_centre(f))) continue;
    for (const double share : {0.25, 0.75}) {
      const PointPlace<2> place = place_on(grid, f, share);
      lengths.push_back(length_to(grid, flux, place));
      const double exact = entering / (1.0 - entering) * std::exp(-lambda * lengths.back());
      worst = std::max(worst, std::abs(fines_at(moments.states[0].liquid, place) / exact - 1.0));
    }
  }
  EXPECT_LE(run.worst_residual(), 1e-12);
  return worst;
}

TEST(FilterPaths, OfRadialFlowAreTheirRadii) {
  std::vector<double> errors;
  for (const int cells : {16, 32}) {
    Scene scene = filter_scene(Formulation::single_point, 30.0);
    scene.boundaries = {inlet_on("top"), model::pressure_on("bottom", 0.0)};
    model::ModelRun run(model::make_case(ring(cells), scene));
    std::vector<double> lengths;
    errors.push_back(worst_at_outlet(
        run, 30.0, [](auto&) { return true; }, lengths));
    EXPECT_EQ(lengths.size(), 40U);
    for (const double length : lengths) EXPECT_NEAR(length, 0.8, 0.003);
  }
  std::cout << "radial: " << errors[0] << " -> " << errors[1] << '\n';
  EXPECT_LT(errors[1], 0.01);
  EXPECT_LT(errors[1], 0.5 * errors[0]);
}

TEST(FilterPaths, OfPointsAreThoseTheyWalked) {
  Scene scene = filter_scene(Formulation::double_point, 30.0);
  scene.boundaries = {inlet_on("top"), model::pressure_on("bottom", 0.0)};
  model::DoublePointRun run(model::make_double_point_case(ring(32), scene));
  const auto moments = run.run({30.0});
  const LiquidPoints<2>& points = moments.states[0].liquid;
  const double y0 = entering / (1.0 - entering) * 2.7;  // by mass
  double worst = 0.0;
  for (int p = 0; p < points.size(); ++p) {
    const double radius = points.place(p).position(run.input().mesh).norm();
    const double exact = y0 * std::exp(-lambda * (1.0 - radius));
    worst = std::max(worst, std::abs(points.fines_mass[p] / points.water_mass[p] / exact - 1.0));
  }
  std::cout << "points: " << worst << '\n';
  EXPECT_GT(points.size(), 10000);
  EXPECT_LT(worst, 0.01);
  EXPECT_LE(run.worst_residual(), 1e-12);
}

/// Water enters the ground on the left of a weir of 0.4 m and leaves it on its right.
TEST(FilterPaths, UnderAWeirAreTheStreamlines) {
  constexpr int cells = 24;
  Mesh<2> mesh = model::column_mesh(2 * cells, cells, 2.0, 1.0);
  BoundarySet<2> upstream{"upstream", {}};
  BoundarySet<2> downstream{"downstream", {}};
  for (const auto& face : mesh.boundaries[0].faces) {
    const double x = 0.5 * (mesh.nodes[face[0]][0] + mesh.nodes[face[1]][0]);
    if (x < 0.8) upstream.faces.push_back(face);
    if (x > 1.2) downstream.faces.push_back(face);
  }
  std::erase_if(mesh.boundaries[0].faces, [&](const auto& face) {
    return std::abs(0.5 * (mesh.nodes[face[0]][0] + mesh.nodes[face[1]][0]) - 1.0) > 0.2;
  });
  mesh.boundaries.push_back(upstream);
  mesh.boundaries.push_back(downstream);
  Scene scene = filter_scene(Formulation::single_point, 150.0);
  scene.boundaries = {inlet_on("upstream"), model::pressure_on("downstream", 0.0)};
  model::ModelRun run(model::make_case(mesh, scene));
  // Faces at the edge of the weir, where the flow is singular, and faces with little flow are left
  // out.
  const auto counts = [](const Vector<2>& x) { return x[0] > 1.25 && x[0] < 1.8; };
  std::vector<double> lengths;
  const double worst = worst_at_outlet(run, 150.0, counts, lengths);
  const auto [shortest, longest] = std::ranges::minmax(lengths);
  std::cout << "weir: " << worst << " over " << shortest << " to " << longest << " m\n";
  EXPECT_GE(lengths.size(), 20U);
  EXPECT_LT(shortest, 0.7);
  EXPECT_GT(longest, 1.6);
  EXPECT_LT(worst, 0.01);
}

}  // namespace filter_paths_test
}  // namespace suffuse
