/// Double-point with the implicit flow: liquid points follow the volumes through faces. The column
/// under a uniform flux is compared with exact profiles for any step.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

#include "double_point_modes.hpp"
#include "exact_fines.hpp"

namespace suffuse {
namespace double_point_faces_test {

constexpr double flux = 0.012;
constexpr double rate = 5e-3;
constexpr double start = 2.0;

Scene faces_scene(int points, double end) {
  Scene scene = model::double_point_scene(flux, rate);
  scene.time.scheme = FlowScheme::implicit_mixed;
  scene.time.end = end;
  scene.points.liquid_per_element = points;
  return scene;
}

struct Errors {
  double concentration = 0.0;  ///< error of points in L2, root mean square over times
  double mass = 0.0;           ///< largest error of the fluidised mass, relative to its maximum
};

/// Errors at 5, 10 ... 30 s in a column 1 m high; the balances of regions must close at these
/// times.
Errors errors_of(int rows, Scene scene, const LayerSettings& layers = {}) {
  model::DoublePointRun run(
      model::make_double_point_case(model::layered_mesh(rows, layers, rows), std::move(scene)));
  const std::vector<double> times = model::times_up_to(30.0, 5.0);
  const auto moments = run.run(times);
  EXPECT_LE(run.worst_residual(), 1e-12);
  const Mesh<2>& mesh = run.input().mesh;
  const int specimen = model::region_index(mesh, "specimen");
  const UniformFines exact([](double) { return rate; }, 0.3, 0.4, start, flux, 31.0);
  Errors errors;
  double most = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const LiquidPoints<2>& liquid = moments.states[k].liquid;
    double square = 0.0;
    double sum = 0.0;
    double mass = 0.0;
    for (int p = 0; p < liquid.size(); ++p) {
      if (mesh.element_region[liquid.element[p]] != specimen) continue;
      const double volume =
          liquid_volume(liquid.water_mass[p], liquid.fines_mass[p], {1000.0, 2700.0}, 1.0);
      const double c = liquid.fines_mass[p] / 2700.0 / volume;
      const double x = 1.0 - liquid.place(p).position(mesh)[1];
      square += volume * std::pow(c - exact.concentration(x, times[k]), 2);
      sum += volume;
      mass += liquid.fines_mass[p];
    }
    errors.concentration += square / sum / static_cast<double>(times.size());
    double expected = 0.0;
    for (int i = 0; i < 2000; ++i) {
      expected += exact.concentration((i + 0.5) / 2000, times[k]) / 2000;
    }
    expected *= 2700.0 * exact.porosity(times[k]);
    most = std::max(most, expected);
    errors.mass = std::max(errors.mass, std::abs(mass - expected));
    for (const RegionRow& row : moments.states[k].regions) {
      EXPECT_LE(std::abs(row.ledger.residual_water), 1e-12);
      EXPECT_LE(std::abs(row.ledger.residual_grains), 1e-12);
    }
  }
  errors.concentration = std::sqrt(errors.concentration);
  errors.mass /= most;
  return errors;
}

TEST(DoublePointFaces, TheErrorDoesNotDependOnTheStep) {
  // Erosion starts within steps of 1.5 and 5 s and ends within steps of 1.5, 4 and 5 s.
  std::vector<double> errors;
  for (const double step : {0.5, 1.0, 1.5, 4.0, 5.0}) {
    Scene scene = faces_scene(12, 30.0);
    scene.time.step = step;
    const Errors e = errors_of(8, std::move(scene));
    std::cout << "steps of " << step << " s: error of c " << e.concentration
              << ", of the fluidised mass " << 100.0 * e.mass << " %\n";
    errors.push_back(e.concentration);
    EXPECT_LE(e.mass, 0.005);
  }
  for (const double error : errors) {
    EXPECT_LE(error, 1.6e-4);
    EXPECT_NEAR(error / errors.front(), 1.0, 0.1);
  }
}

TEST(DoublePointFaces, TheStepChosenByTheSolverIsAsGood) {
  for (const int points : {1, 3, 12}) {
    const Errors e = errors_of(8, faces_scene(points, 30.0));
    std::cout << points << " points per element: error of c " << e.concentration
              << ", of the fluidised mass " << 100.0 * e.mass << " %\n";
    EXPECT_LE(e.concentration, points == 1 ? 2.5e-3 : points == 3 ? 8e-4 : 1.6e-4);
  }
}

TEST(DoublePointFaces, BetweenLayersOfSoilAndWater) {
  LayerSettings layers;
  layers.inflow = layers.above = layers.below = layers.outflow = 1;
  const Errors e = errors_of(8, faces_scene(12, 30.0), layers);
  std::cout << "between layers: error of c " << e.concentration << ", of the fluidised mass "
            << 100.0 * e.mass << " %\n";
  EXPECT_LE(e.concentration, 3e-4);
  EXPECT_LE(e.mass, 0.005);
}

TEST(DoublePointFaces, ThePapersModeClosesItsBooksToo) {
  Scene scene = faces_scene(3, 30.0);
  model::use_paper_mode(scene);
  const Errors e = errors_of(8, std::move(scene));
  std::cout << "paper's mode, 3 points: error of c " << e.concentration << '\n';
  EXPECT_LE(e.concentration, 0.025);
}

TEST(DoublePointFaces, InAFlowThatTurns) {
  // Water enters on the left and leaves at the top. Where a whole soil erodes at one rate, c = 1 -
  // n(t_in) / n(t) on any path. The number of a point gives its time of entry within `every`,
  // because every output keeps the numbers of the run.
  constexpr double every = 0.5;
  constexpr double end = 20.0;
  Scene scene = faces_scene(12, end);
  scene.boundaries = {model::flux_on("left", flux), model::pressure_on("top", 0.0)};
  model::DoublePointRun run(model::make_double_point_case(
      model::column_mesh(8, 8, 1.0, 1.0, model::jittered(0.03, 5)), std::move(scene)));
  const std::vector<double> times = model::times_up_to(end, every);
  const auto moments = run.run(times);
  EXPECT_LE(run.worst_residual(), 1e-12);
  const auto porosity = [](double t) { return 0.3 + rate * std::max(0.0, t - start); };

  std::map<long, double> seen;  // first time at which a point is seen, by its number
  double worst = 0.0;
  int injected = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const LiquidPoints<2>& liquid = moments.states[k].liquid;
    const double n = porosity(times[k]);
    for (int p = 0; p < liquid.size(); ++p) {
      const double first = seen.try_emplace(liquid.id[p], times[k]).first->second;
      const double volume =
          liquid_volume(liquid.water_mass[p], liquid.fines_mass[p], {1000.0, 2700.0}, 1.0);
      const double c = liquid.fines_mass[p] / 2700.0 / volume;
      const bool from_outside = liquid.id[p] >= run.input().liquid_points.size();
      const double most = 1.0 - porosity(from_outside ? first - every : 0.0) / n;
      const double least = 1.0 - porosity(from_outside ? first : 0.0) / n;
      worst = std::max({worst, c - most, least - c});
      injected += from_outside ? 1 : 0;
    }
  }
  std::cout << "in a flow that turns: c of any point at most " << worst << " off\n";
  EXPECT_GE(injected, 1000);
  EXPECT_LE(worst, 1e-3);
}

TEST(DoublePointFaces, ThreadsChangeNothing) {
  const auto result = [](int threads) {
    SolverOptions options;
    options.threads = threads;
    model::DoublePointRun run(
        model::make_double_point_case(model::layered_mesh(16, {}, 16), faces_scene(12, 10.0)),
        options);
    run.run({10.0});
    return std::pair{run.model().liquid().points().barycentric,
                     run.model().liquid().points().fines_mass};
  };
  EXPECT_EQ(result(1), result(3));
}

}  // namespace double_point_faces_test
}  // namespace suffuse
