/// Liquid points along given face volumes while the solid erodes: the column of the paper's soil
/// under a uniform flux, without a flow scheme.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

#include "points/points_along_faces.hpp"
#include "solver/counting_skeleton.hpp"
#include "solver/double_point_case.hpp"
#include "verification/exact_fines.hpp"

namespace suffuse {
namespace points_along_faces_test {

constexpr LiquidDensities densities{1000.0, 2700.0};
constexpr double bulk_modulus = 2.0e7;
constexpr double flux = 0.012;
constexpr double rate = 5e-3;
constexpr double start = 2.0;

struct Column {
  Column(Mesh<2> mesh, Scene scene, int threads = 1)
      : input(model::make_double_point_case(std::move(mesh), std::move(scene))),
        grid(input.mesh),
        soils(input),
        solid(grid, soils, {}, threads),
        conditions(face_conditions(input, grid)),
        pressure(input.mesh.element_count(), 0.0),
        liquid(grid, solid, conditions, injection_settings(input, grid), densities, bulk_modulus,
               threads, input.liquid_points, pressure) {
    for (const Vector<2>& normal : grid.face_normal) {
      const bool vertical = std::abs(normal[1]) <= 1e-12 * normal.norm();
      face_rate.push_back(vertical ? 0.0 : -flux * normal[1]);
    }
  }
  Column(const Column&) = delete;
  Column& operator=(const Column&) = delete;
  ~Column() = default;

  /// One step of transport, of any length.
  void step(double dt) {
    FlowProgress flow{1, dt, time + dt, {face_rate, {}}};
    for (double& volume : flow.volumes.liquid) volume *= dt;
    const RegionCrossings& crossed = liquid.move(time, flow, pressure, exchange, 1.0);
    eroded = densities.grain * solid.given();
    note(crossed);
    time += dt;
  }

  void note(const RegionCrossings& crossings) {
    for (const PointCrossing& point : crossings.points) {
      if (point.from < 0) fines_in += point.fines_mass;
      if (point.to < 0) fines_out += point.fines_mass;
      if (point.from >= 0) received.at(point.from) -= point.fines_mass;
      if (point.to >= 0) received.at(point.to) += point.fines_mass;
    }
    for (std::size_t r = 0; r < crossings.fines_out.size(); ++r) {
      received[r] -= crossings.fines_out[r];
    }
  }

  [[nodiscard]] double fines() const {
    const LiquidPoints<2> points = liquid.points();
    return std::accumulate(points.fines_mass.begin(), points.fines_mass.end(), 0.0);
  }
  /// Fines that are neither in the liquid nor booked, relative to the eroded fines.
  [[nodiscard]] double residual() const {
    const auto& pending = liquid.pending();
    const double waiting = densities.grain * std::accumulate(pending.begin(), pending.end(), 0.0);
    return (fines() + waiting + fines_out - fines_in - eroded) / std::max(eroded, 1.0);
  }
  /// Largest difference between the fines of a region, solid and liquid, and the booked ones.
  [[nodiscard]] double region_residual() const {
    std::vector<double> left = received;
    for (int s = 0; s < soils.points().size(); ++s) {
      left[input.mesh.element_region[soils.points().element[s]]] +=
          densities.grain * soils.points().volume[s] *
          (solid.porosity()[s] - solid.initial_porosity()[s]);
    }
    const LiquidPoints<2> points = liquid.points();
    for (int p = 0; p < points.size(); ++p) {
      left[input.mesh.element_region[points.element[p]]] -= points.fines_mass[p];
    }
    double largest = 0.0;
    for (const double mass : left) largest = std::max(largest, std::abs(mass));
    return largest / std::max(eroded, 1.0);
  }
  /// Root mean square of the error of c over the liquid, x from the inlet.
  [[nodiscard]] double error(const std::function<double(double)>& exact,
                             double height = 1.0) const {
    double square = 0.0;
    double sum = 0.0;
    const LiquidPoints<2> points = liquid.points();
    for (int p = 0; p < points.size(); ++p) {
      const double volume =
          liquid_volume(points.water_mass[p], points.fines_mass[p], densities, 1.0);
      const double c = points.fines_mass[p] / densities.grain / volume;
      const double x = height - points.place(p).position(input.mesh)[1];
      square += volume * std::pow(c - exact(x), 2);
      sum += volume;
    }
    return std::sqrt(square / sum);
  }

  Case<2> input;
  Grid<2> grid;
  SoilMap<2> soils;
  CountingSkeleton<2> solid;
  SolidExchange<2> exchange{solid, [](PointFlows&) {}};
  std::vector<FaceCondition> conditions;
  std::vector<double> pressure;
  PointsAlongFaces<2> liquid;
  std::vector<double> face_rate;  ///< rates of a vertical Darcy flux downwards, m3/s
  double time = 0.0;
  double eroded = 0.0;
  double fines_in = 0.0;
  double fines_out = 0.0;
  /// Booked gain of fines of each region, without those of its own solid.
  std::vector<double> received = std::vector<double>(8, 0.0);
};

struct Outcome {
  double error = 0.0;  ///< error of c in L2, root mean square over times
  double mass = 0.0;   ///< largest error of the fluidised mass, relative to its maximum
};

/// Compares every two seconds up to `end`, in a column 1 m high of `rows` rows and `across` columns
/// of cells.
Outcome run(int rows, int across, int points, double dt) {
  constexpr double end = 30.0;
  Scene scene = model::double_point_scene(flux, rate);
  scene.points.liquid_per_element = points;
  const double width = static_cast<double>(across) / rows;
  Column column(model::layered_mesh(across, {}, rows, width), std::move(scene));
  const UniformFines exact([](double) { return rate; }, 0.3, 0.4, start, flux, end + 1.0);
  Outcome outcome;
  double square = 0.0;
  double most = 0.0;
  int times = 0;
  const int every = static_cast<int>(std::lround(2.0 / dt));
  for (int k = 1; k * dt < end + 1e-9; ++k) {
    column.step(dt);
    EXPECT_LE(std::abs(column.residual()), 1e-13);
    if (k % every != 0) continue;
    const double t = column.time;
    const auto concentration = [&](double x) { return exact.concentration(x, t); };
    square += std::pow(column.error(concentration), 2);
    ++times;
    double mass = 0.0;
    for (int i = 0; i < 2000; ++i) mass += concentration((i + 0.5) / 2000) / 2000;
    mass *= densities.grain * exact.porosity(t) * width;
    most = std::max(most, mass);
    outcome.mass = std::max(outcome.mass, std::abs(column.fines() - mass));
  }
  outcome.mass /= most;
  outcome.error = std::sqrt(square / times);
  return outcome;
}

TEST(PointsAlongFaces, TheErrorIsThatOfThePointsWhateverTheStep) {
  // Points cross 0.65 of an element in 2 s, more than one element of the finer mesh.
  for (const int rows : {8, 16}) {
    for (const int points : {1, 3, 12}) {
      std::vector<double> errors;
      for (const double dt : {2.0, 1.0, 0.5, 0.25}) {
        errors.push_back(run(rows, rows / 2, points, dt).error);
      }
      std::cout << rows << " rows, " << points
                << " points per element: error of c at steps of 2, 1, "
                << "1/2, 1/4 s " << errors[0] << ' ' << errors[1] << ' ' << errors[2] << ' '
                << errors[3] << '\n';
      for (const double error : errors) EXPECT_NEAR(error / errors.back(), 1.0, 0.1);
      EXPECT_LE(errors[1], points == 1 ? 2.3e-3 : points == 3 ? 8e-4 : 2e-4);
    }
  }
}

TEST(PointsAlongFaces, FluidisedMass) {
  const Outcome coarse = run(4, 4, 12, 1.0);
  const Outcome fine = run(8, 8, 12, 1.0);
  const Outcome finer_step = run(8, 8, 12, 0.25);
  std::cout << "fluidised mass, 12 points per element, steps of 1 s: largest error "
            << 100.0 * coarse.mass << " % at 1/4 m, " << 100.0 * fine.mass
            << " % at 1/8 m; steps of 1/4 s " << 100.0 * finer_step.mass << " %\n";
  EXPECT_LE(fine.mass, 0.005);
  EXPECT_LE(coarse.mass, 0.016);
  // Points are whole: the volume of the points in the column is never exactly that of its pores.
  EXPECT_NEAR(fine.mass, finer_step.mass, 2e-4);
}

TEST(PointsAlongFaces, SecondOrderWherePorosityCurvesInTime) {
  // phi_e = kappa (n_max - n): within a step porosity is assumed linear in time.
  constexpr double kappa = 0.25;
  constexpr double end = 24.0;
  std::vector<double> errors;
  const UniformFines exact([](double n) { return kappa * (0.4 - n); }, 0.2, 0.4, 0.0, flux, end);
  for (const double dt : {6.0, 3.0, 1.5}) {
    Scene scene = model::double_point_scene(flux, kappa);
    scene.soils[0].porosity = 0.2;
    scene.soils[0].erosion.law = erosion_law("first-order");
    scene.soils[0].erosion.start = 0.0;
    scene.points.liquid_per_element = 48;
    Column column(model::layered_mesh(4, {}, 8, 0.5), std::move(scene));
    double square = 0.0;
    for (int k = 1; k * dt < end + 1e-9; ++k) {
      column.step(dt);
      EXPECT_LE(std::abs(column.residual()), 1e-13);
      if (std::fmod(column.time, 6.0) != 0.0) continue;
      square +=
          std::pow(column.error([&](double x) { return exact.concentration(x, column.time); }), 2);
    }
    errors.push_back(std::sqrt(square / 4.0));
  }
  for (int k = 0; k < 2; ++k) {
    const double order = std::log2(errors[k] / errors[k + 1]);
    std::cout << "first-order law, steps of " << 6.0 / (1 << k) << " and " << 3.0 / (1 << k)
              << " s: error of c " << errors[k] << ' ' << errors[k + 1] << ", order " << order
              << '\n';
    EXPECT_GE(order, 1.8);
  }
}

TEST(PointsAlongFaces, PorosityThatVariesWithDepth) {
  // n_0 = 0.25 + 0.1 x with x from the inlet: (1 - c) n_L is not constant on a path.
  constexpr double slow = 1e-3;
  const auto porosity = [](double x, double t) {
    return 0.25 + 0.1 * x + slow * std::max(0.0, t - start);
  };
  std::vector<double> errors;
  for (const int rows : {8, 16}) {
    Scene scene = model::double_point_scene(flux, slow);
    scene.soils[0].porosity = 0.35;
    scene.soils[0].porosity_gradient = {0.0, -0.1, 0.0};
    scene.points.liquid_per_element = 12;
    Column column(model::layered_mesh(rows / 4, {}, rows, 0.25), std::move(scene));
    for (int k = 1; k <= 21; ++k) column.step(2.0);
    const auto exact = [&](double x) {
      return concentration_along_path(
          porosity, [](double, double) { return slow; }, start, flux, x, column.time);
    };
    errors.push_back(column.error(exact) / exact(1.0));
  }
  std::cout << "porosity that varies with depth, 8 and 16 rows: error of c " << errors[0] << ' '
            << errors[1] << " of that at the outlet\n";
  EXPECT_LE(errors[0], 1e-3);
  EXPECT_LE(errors[1], 1e-3);
}

TEST(PointsAlongFaces, BooksCloseForEveryRegion) {
  // The steps cross layers of one row within one step, and the last one crosses the whole column.
  for (const MassTransfer way : {MassTransfer::nodal, MassTransfer::element}) {
    Scene scene = model::double_point_scene(flux, rate);
    scene.soils[0].erosion.mass_transfer = way;
    scene.points.liquid_per_element = 3;
    LayerSettings layers;
    layers.above = layers.below = 1;
    Column column(model::layered_mesh(4, layers, 8, 0.5), std::move(scene));
    for (const double dt : {1.0, 3.0, 7.0, 60.0}) {
      column.step(dt);
      EXPECT_LE(std::abs(column.residual()), 1e-13);
      EXPECT_LE(column.region_residual(), 1e-12) << "after a step of " << dt << " s";
    }
    EXPECT_GT(column.fines_out, 0.5 * column.eroded);
    // The liquid present now entered clean during the last step and passed eroding soil.
    EXPECT_LT(column.fines(), 0.5 * column.eroded);
  }
}

TEST(PointsAlongFaces, FinesStayInSoilThatErodes) {
  // The regions above the specimen receive no fines.
  Scene scene = model::double_point_scene(flux, rate);
  LayerSettings layers;
  layers.above = 4;
  Column column(model::layered_mesh(4, layers, 8, 0.5), std::move(scene));
  for (int k = 0; k < 10; ++k) column.step(2.0);
  const LiquidPoints<2> points = column.liquid.points();
  for (int p = 0; p < points.size(); ++p) {
    if (points.place(p).position(column.input.mesh)[1] <= 1.0) continue;
    EXPECT_EQ(points.fines_mass[p], 0.0);
  }
}

/// Points of equal volume may leave out an element that holds less than one: what enters there
/// comes in points of the mean volume.
TEST(PointsAlongFaces, EnterThroughElementsWithoutAPoint) {
  Case<2> c = model::make_double_point_case(model::column_mesh(2, 2),
                                            model::double_point_scene(flux, rate));
  const Grid<2> grid(c.mesh);
  MaterialPoints<2>& points = c.liquid_points;
  const double mean =
      std::accumulate(points.volume.begin(), points.volume.end(), 0.0) / points.size();
  int face = 0;
  while (!grid.is_outer(face)) ++face;
  std::ranges::replace(points.element, grid.face_left[face], grid.face_left[face] + 1);
  const InjectionSettings settings = injection_settings(c, grid);
  EXPECT_EQ(settings.points_per_element[face], 1);
  EXPECT_NEAR(settings.point_volume[face], mean, 1e-13 * mean);
}

TEST(PointsAlongFaces, ThreadsChangeNothing) {
  const auto fines = [](int threads) {
    Column column(model::layered_mesh(16, {}, 16), model::double_point_scene(flux, rate), threads);
    EXPECT_GE(column.liquid.size(), 5000);
    for (int k = 0; k < 5; ++k) column.step(2.0);
    const LiquidPoints<2> points = column.liquid.points();
    return std::pair{points.fines_mass, points.barycentric};
  };
  EXPECT_EQ(fines(1), fines(3));
}

TEST(PointsAlongFaces, StepsMayCrossOneElement) {
  Column column(model::layered_mesh(4, {}, 4), model::double_point_scene(flux, rate));
  // Elements of 1/4 m at 0.04 m/s: 6.25 s.
  EXPECT_NEAR(column.liquid.longest_step(column.face_rate), transport_safety * 6.25, 1e-12);
}

}  // namespace points_along_faces_test
}  // namespace suffuse
