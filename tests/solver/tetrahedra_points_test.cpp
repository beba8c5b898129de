/// Liquid points along face volumes in a box of tetrahedra while the solid erodes: the column of
/// the paper's soil under a uniform flux, without a flow scheme.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numeric>

#include "box_mesh.hpp"
#include "points/points_along_faces.hpp"
#include "solver/counting_skeleton.hpp"
#include "solver/model_case.hpp"
#include "verification/exact_fines.hpp"

namespace suffuse {
namespace tetrahedra_points_test {

constexpr LiquidDensities densities{1000.0, 2700.0};
constexpr double flux = 0.012;
constexpr double rate = 5e-3;
constexpr double start = 2.0;

/// A box with `per_element` liquid points in each element, at the Gauss positions.
struct Box {
  explicit Box(Mesh<3> mesh)
      : input(make(std::move(mesh))),
        grid(input.mesh),
        soils(input),
        solid(grid, soils, {}, 1),
        conditions(face_conditions(input, grid)),
        pressure(input.mesh.element_count(), 0.0),
        liquid(grid, solid, conditions, injection(), densities, 2.0e7, 1, input.liquid_points,
               pressure) {
    for (int f = 0; f < grid.face_count(); ++f) {
      const bool wall = conditions[f].kind == FaceKind::wall;
      face_rate.push_back(wall ? 0.0 : -flux * grid.face_normal[f][2]);
    }
  }
  static Case<3> make(Mesh<3> mesh) {
    Scene scene = model::paper_scene();
    scene.soils[0].erosion.law = erosion_law("constant");
    scene.soils[0].erosion.rate = rate;
    scene.soils[0].erosion.start = start;
    scene.boundaries = {model::flux_on("top", flux), model::pressure_on("bottom", 0.0)};
    Case<3> c = model::make_case(std::move(mesh), scene);
    c.liquid_points = c.solid_points;
    for (double& volume : c.liquid_points.volume) volume *= scene.soils[0].porosity;
    return c;
  }
  [[nodiscard]] InjectionSettings injection() const {
    InjectionSettings result;
    for (const int e : grid.face_left) {
      result.point_volume.push_back(0.3 * grid.volume[e] / 4.0);
      result.points_per_element.push_back(4);
    }
    return result;
  }
  void step(double dt) {
    FlowProgress flow{1, dt, time + dt, {face_rate, {}}};
    for (double& volume : flow.volumes.liquid) volume *= dt;
    const RegionCrossings& crossed = liquid.move(time, flow, pressure, exchange, 1.0);
    eroded = densities.grain * solid.given();
    for (const PointCrossing& point : crossed.points) {
      if (point.to < 0) fines_out += point.fines_mass;
    }
    time += dt;
  }
  [[nodiscard]] double residual() const {
    const LiquidPoints<3> points = liquid.points();
    const double inside = std::accumulate(points.fines_mass.begin(), points.fines_mass.end(), 0.0);
    const double waiting =
        densities.grain * std::accumulate(liquid.pending().begin(), liquid.pending().end(), 0.0);
    return (inside + waiting + fines_out - eroded) / std::max(eroded, 1.0);
  }
  /// Root mean square of the error of c over the liquid, x from the inlet.
  [[nodiscard]] double error(const UniformFines& exact) const {
    double square = 0.0;
    double sum = 0.0;
    const LiquidPoints<3> points = liquid.points();
    for (int p = 0; p < points.size(); ++p) {
      const double volume =
          liquid_volume(points.water_mass[p], points.fines_mass[p], densities, 1.0);
      const double c = points.fines_mass[p] / densities.grain / volume;
      const double x = 1.0 - points.place(p).position(input.mesh)[2];
      square += volume * std::pow(c - exact.concentration(x, time), 2);
      sum += volume;
    }
    return std::sqrt(square / sum);
  }

  Case<3> input;
  Grid<3> grid;
  SoilMap<3> soils;
  CountingSkeleton<3> solid;
  SolidExchange<3> exchange{solid, [](PointFlows&) {}};
  std::vector<FaceCondition> conditions;
  std::vector<double> pressure;
  PointsAlongFaces<3> liquid;
  std::vector<double> face_rate;
  double time = 0.0;
  double eroded = 0.0;
  double fines_out = 0.0;
};

TEST(TetrahedraPoints, CarryFinesAsTheExactSolutionDoes) {
  constexpr double end = 30.0;
  const UniformFines exact([](double) { return rate; }, 0.3, 0.4, start, flux, end);
  const Vector<3> size(0.5, 0.5, 1.0);
  for (const double amount : {0.0, 0.02}) {
    Box box(model::box_mesh({4, 4, 8}, size, model::disturbed(amount, size)));
    double worst = 0.0;
    for (int k = 0; k < 15; ++k) {
      box.step(2.0);
      EXPECT_LE(std::abs(box.residual()), 1e-12);
      worst = std::max(worst, box.error(exact));
    }
    std::cout << "points along faces in 3D, nodes off by " << amount << " m: error of c " << worst
              << " of " << exact.concentration(1.0, end) << '\n';
    // 1 % of the range of c.
    EXPECT_LE(worst, 0.01 * exact.concentration(1.0, end));
    EXPECT_GT(box.fines_out, 0.1 * box.eroded);
  }
}

}  // namespace tetrahedra_points_test
}  // namespace suffuse
