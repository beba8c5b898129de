/// Passes of the single-point formulation: erosion, transport with its limiter, over three points
/// per element; and the pieces of an implicit step.

#include <cmath>

#include "bench/bench.hpp"
#include "field/eulerian.hpp"
#include "field/swept_field.hpp"
#include "grid/flux_correction.hpp"
#include "linear/cholesky_factor.hpp"
#include "mixed/implicit_mixed.hpp"
#include "solid/pores.hpp"
#include "solid/rigid_skeleton.hpp"
#include "solver/model_case.hpp"

namespace suffuse::bench {
namespace {

/// A square of soil with a uniform flow from top to bottom and grains that vary in space.
struct Column {
  explicit Column(int cells, int threads)
      : c(make(cells)),
        grid(c.mesh),
        conditions(face_conditions(c, grid)),
        soils(c),
        skeleton(grid, soils, {}, threads),
        sides(grid),
        transport(grid, sides, conditions, threads) {
    state.liquid_volume = initial_pore_volume(grid, soils);
    state.fines_volume = state.liquid_volume;
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      const Vector<2> x = element_centroid(grid.mesh, e);
      for (double& v : state.fines_volume[e]) v *= 0.2 + 0.1 * std::sin(7.0 * x[0] + 5.0 * x[1]);
    }
    for (int f = 0; f < grid.face_count(); ++f) {
      const bool wall = conditions[f].kind == FaceKind::wall;
      volume.push_back(wall ? 0.0 : grid.face_normal[f].dot(Vector<2>(0.0, -0.012)));
    }
    const double allowed = 0.9 * transport.steps_allowed(state, volume);
    for (double& v : volume) v *= allowed;
  }

  static Case<2> make(int cells) {
    Scene scene = model::paper_scene();
    scene.soils[0].erosion = {erosion_law("constant"), 1e-9, 0.0, false};
    scene.boundaries = {model::flux_on("top", 0.012), model::pressure_on("bottom", 0.0)};
    return model::make_case(model::column_mesh(cells, cells), scene);
  }

  [[nodiscard]] double points() const { return soils.points().size(); }

  Case<2> c;
  Grid<2> grid;
  std::vector<FaceCondition> conditions;
  SoilMap<2> soils;
  RigidSkeleton<2> skeleton;
  ElementSides<2> sides;
  EulerianTransport<2> transport;
  FinesState<2> state;
  std::vector<double> volume;
};

/// Number of cells along a side for about `elements` elements.
int cells_for(double elements) {
  return static_cast<int>(std::lround(std::sqrt(0.5 * elements)));
}

// Bytes are counted once per loop that reads or writes an array; shared values are counted once.

void Transport(benchmark::State& bench) {
  const auto threads = static_cast<int>(bench.range(1));
  Column column(cells_for(static_cast<double>(bench.range(0))), threads);
  TransportScratch<2> scratch;
  ElementField<2> eroded(column.grid.mesh.element_count(), ElementValues<2>{});
  column.transport.start(column.state, column.volume, scratch);
  for ([[maybe_unused]] const auto step : bench) {
    column.transport.advance(column.state, eroded, {}, scratch);
  }
  constexpr double gain = 24 + 24 + 24 + 48;          // vertices, outflow, upwind, grains out
  constexpr double first = gain + 24 + 48 + 48 + 24;  // eroded, pores, fines, stage
  constexpr double second = gain + 24 + 48 + 24;      // pores, fines, stage
  constexpr double limiter = 2.0 * (24 + 8) + 8 + 12 + 8 + 12 + 16;  // found, then limited
  report(bench, column.points(), (first + second + 2.0 * limiter) / 3.0, threads);
}
BENCHMARK(Transport)
    ->ArgNames({"elements", "threads"})
    ->ArgsProduct({{3'300, 33'000, 333'000}, {1, 2}})
    ->UseRealTime();
BENCHMARK(Transport)->Name("QuickTransport")->Args({3'300, 1})->UseRealTime();

/// Like `Transport`, for one swept step of a hundred times the explicit step, without erosion.
void Sweep(benchmark::State& bench) {
  Column column(cells_for(static_cast<double>(bench.range(0))), 1);
  const BoundaryValues<2> values(column.c, column.grid);
  SweptField<2> field(column.grid, column.sides, column.soils, values, 1);
  for (double& v : column.volume) v *= 100.0;
  field.start(column.volume, {});
  const PointFlows flows;
  StepErrors errors;
  const ElementField<2> nothing(column.grid.mesh.element_count(), ElementValues<2>{});
  for ([[maybe_unused]] const auto step : bench) {
    benchmark::DoNotOptimize(
        field.solve(column.state, {column.skeleton, flows, 0.0, 1.0, false}, 1.0, errors));
    field.finish(column.state, nothing);
  }
  constexpr double element = 24 + 24 + 24 + 24 + 48 + 24;
  report(bench, column.points(), 2.0 * element / 3.0, 1);
}
BENCHMARK(Sweep)
    ->ArgNames({"elements"})
    ->Args({3'300})
    ->Args({33'000})
    ->Args({333'000})
    ->Args({1'000'000})
    ->UseRealTime();

void Erosion(benchmark::State& bench) {
  const auto threads = static_cast<int>(bench.range(1));
  Column column(cells_for(static_cast<double>(bench.range(0))), threads);
  std::vector<double> exchange;
  double time = 0.0;
  for ([[maybe_unused]] const auto step : bench) {
    column.skeleton.exchange(time, time + 1.0, {}, {}, exchange);
    time += 1.0;
  }
  report(bench, column.points(), 16.0 + 8.0 + 8.0 + 8.0 / 3.0, threads);
}
BENCHMARK(Erosion)
    ->ArgNames({"elements", "threads"})
    ->ArgsProduct({{3'300, 33'000, 333'000}, {1, 2}})
    ->UseRealTime();

/// What an implicit step of the column needs.
struct ImplicitColumn : Column {
  ImplicitColumn(int cells, int threads)
      : Column(cells, threads),
        scheme(grid, {2e7, false, TimeStepping::second_order, threads}, Vector<2>::Zero()),
        forcing{model::flow_coefficients(grid, 2e-2), conditions, {}} {
    begin.face_pressure.assign(grid.face_count(), 0.0);
    begin.velocity.assign(grid.mesh.element_count(), Vector<2>::Zero());
  }
  /// The matrix of the pressures at faces, with the same pattern and similar values.
  [[nodiscard]] Eigen::SparseMatrix<double> matrix() const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int e = 0; e < grid.mesh.element_count(); ++e) {
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          const auto normal = [&](int k) {
            return Vector<2>(grid.element_face_sign[e][k] *
                             grid.face_normal[grid.element_face[e][k]]);
          };
          const double storage = a == b ? 1e-3 : 0.0;
          entries.emplace_back(grid.element_face[e][a], grid.element_face[e][b],
                               normal(a).dot(normal(b)) / grid.volume[e] + storage);
        }
      }
    }
    Eigen::SparseMatrix<double> result(grid.face_count(), grid.face_count());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
  /// One step; if `longer` is not zero, its length changes and so does the matrix.
  void step(double longer) {
    benchmark::DoNotOptimize(scheme.step(begin, 1.0 + longer, {&forcing, &forcing}));
  }

  ImplicitMixed<2> scheme;
  FlowForcing<2> forcing;
  MixedState<2> begin;
};

void add_sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"elements", "threads"})
      ->ArgsProduct({{3'000, 33'000, 333'000}, {1, 2}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

/// Two stages with a factored matrix: assembly, one solution each, fluxes.
void ImplicitStep(benchmark::State& bench) {
  ImplicitColumn column(cells_for(static_cast<double>(bench.range(0))),
                        static_cast<int>(bench.range(1)));
  column.step(0.0);
  for ([[maybe_unused]] const auto step : bench) column.step(0.0);
}
BENCHMARK(ImplicitStep)->Apply(add_sizes);

/// A step whose matrix has changed by about a thousandth, solved by conjugate gradients.
void ImplicitStepWithIterations(benchmark::State& bench) {
  ImplicitColumn column(cells_for(static_cast<double>(bench.range(0))),
                        static_cast<int>(bench.range(1)));
  column.step(0.0);
  double longer = 0.0;
  for ([[maybe_unused]] const auto step : bench) column.step(longer += 1e-6);
}
BENCHMARK(ImplicitStepWithIterations)->Apply(add_sizes);

void Order(benchmark::State& bench) {
  const ImplicitColumn column(cells_for(static_cast<double>(bench.range(0))), 1);
  const Eigen::SparseMatrix<double> matrix = column.matrix();
  for ([[maybe_unused]] const auto step : bench) {
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
    factor.analyzePattern(matrix);
  }
}
BENCHMARK(Order)
    ->ArgName("elements")
    ->Arg(3'000)
    ->Arg(33'000)
    ->Arg(333'000)
    ->Unit(benchmark::kMillisecond);

void Factorise(benchmark::State& bench) {
  const ImplicitColumn column(cells_for(static_cast<double>(bench.range(0))), 1);
  const Eigen::SparseMatrix<double> matrix = column.matrix();
  CholeskyFactor factor;
  factor.factorise(matrix);
  for ([[maybe_unused]] const auto step : bench) factor.factorise(matrix);
}
BENCHMARK(Factorise)
    ->ArgName("elements")
    ->Arg(3'000)
    ->Arg(33'000)
    ->Arg(333'000)
    ->Unit(benchmark::kMillisecond);

void Solve(benchmark::State& bench) {
  const ImplicitColumn column(cells_for(static_cast<double>(bench.range(0))), 1);
  const Eigen::SparseMatrix<double> matrix = column.matrix();
  CholeskyFactor factor;
  factor.factorise(matrix);
  const Eigen::VectorXd rhs = Eigen::VectorXd::Random(matrix.rows());
  Eigen::VectorXd x;
  for ([[maybe_unused]] const auto step : bench) factor.solve(rhs, x);
}
BENCHMARK(Solve)
    ->ArgName("elements")
    ->Arg(3'000)
    ->Arg(33'000)
    ->Arg(333'000)
    ->Unit(benchmark::kMillisecond);

/// Solves with Eigen's substitution, which the plain loops of CholeskyFactor replace.
void SolveByEigen(benchmark::State& bench) {
  const ImplicitColumn column(cells_for(static_cast<double>(bench.range(0))), 1);
  const Eigen::SparseMatrix<double> matrix = column.matrix();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Eigen::VectorXd rhs = Eigen::VectorXd::Random(matrix.rows());
  Eigen::VectorXd x;
  for ([[maybe_unused]] const auto step : bench) x = factor.solve(rhs);
}
BENCHMARK(SolveByEigen)
    ->ArgName("elements")
    ->Arg(3'000)
    ->Arg(33'000)
    ->Arg(333'000)
    ->Unit(benchmark::kMillisecond);

void CorrectFluxes(benchmark::State& bench) {
  ImplicitColumn column(cells_for(static_cast<double>(bench.range(0))), 1);
  std::vector<char> held;
  for (const FaceCondition& c : column.conditions) {
    held.push_back(c.kind == FaceKind::pressure ? 1 : 0);
  }
  FluxCorrection<2> correction(column.grid, held);
  correction.follow(std::vector<double>(column.grid.mesh.element_count(), 1.0));
  const std::vector<double> outflow(column.grid.mesh.element_count(), 0.0);
  for ([[maybe_unused]] const auto step : bench) correction.correct(column.volume, outflow);
}
BENCHMARK(CorrectFluxes)
    ->ArgName("elements")
    ->Arg(3'000)
    ->Arg(33'000)
    ->Arg(333'000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace suffuse::bench
