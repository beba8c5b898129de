/// Liquid points that carry the flow: the passes of one step, each by itself and together, on the
/// paper's column made fine, with 12 points per element. Water flows so fast that points cross
/// faces in each step; `percent` says by how much of an element they move.

#include <map>
#include <memory>

#include "bench/bench.hpp"
#include "solver/carried_column.hpp"

namespace suffuse::bench {
namespace {

/// A column of about `state.range(0)` points, kept from one benchmark to the next.
model::Column& column_of(const benchmark::State& state) {
  struct Kept {
    Case<2> input;
    std::unique_ptr<model::Column> column;
  };
  static std::map<std::array<long, 3>, Kept> all;
  const std::array<long, 3> key{state.range(0), state.range(1), state.range(2)};
  if (!all.contains(key)) {
    all.clear();
    Kept& kept = all[key];
    const double columns = std::sqrt(static_cast<double>(key[0]) / 24.0);
    kept.input = model::fast_column(static_cast<int>(columns), static_cast<double>(key[2]) / 14.0);
    kept.column = std::make_unique<model::Column>(kept.input, static_cast<int>(key[1]));
    // After this, blocks have the sizes that they need.
    for (int k = 0; k < 20; ++k) kept.column->move();
  }
  return *all.at(key).column;
}

/// Each call of `loop` moves `point_bytes` per point and `element_bytes` per element.
template <class Loop>
void measure(benchmark::State& state, double point_bytes, double element_bytes, const Loop& loop) {
  model::Column& column = column_of(state);
  const long ids = column.inflow().next_id;
  for ([[maybe_unused]] const auto step : state) loop(column);
  const double points = column.carried().blocks().size();
  const auto elements = static_cast<double>(column.grid().mesh.element_count());
  report(state, points, point_bytes + element_bytes * elements / points,
         static_cast<int>(state.range(1)));
  state.counters["crossing"] = static_cast<double>(column.carried().travelled()) / points;
  state.counters["injected"] =
      static_cast<double>(column.inflow().next_id - ids) / static_cast<double>(state.iterations());
}

constexpr double point_bytes = sizeof(CarriedPoint<2>);

/// Reads every point; reads and writes sums at each corner.
void PointsToGrid(benchmark::State& state) {
  measure(state, point_bytes, 2 * 72 + 8 + 16,
          [](model::Column& column) { column.points_to_grid(); });
}

/// Reads and writes every point; reads flux, velocities, pressures and gradients of each element.
void GridToPoints(benchmark::State& state) {
  measure(state, 2.0 * point_bytes, 48 + 12 + 3 * 8 + 48,
          [](model::Column& column) { column.grid_to_points(); });
}

/// The part of a step at the nodes.
void Flow(benchmark::State& state) {
  measure(state, 0.0, 200, [](model::Column& column) { column.step(); });
}

void Step(benchmark::State& state) {
  measure(state, 3.0 * point_bytes, 500, [](model::Column& column) { column.move(); });
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"points", "threads", "percent"})->UseRealTime();
  for (const int points : {10'000, 100'000, 1'000'000}) {
    for (const int threads : {1, 2}) {
      for (const int percent : {2, 14}) benchmark->Args({points, threads, percent});
    }
  }
}
BENCHMARK(PointsToGrid)->Apply(sizes);
BENCHMARK(GridToPoints)->Apply(sizes);
BENCHMARK(Flow)->Apply(sizes);
BENCHMARK(Step)->Apply(sizes);
BENCHMARK(Step)->Name("QuickStep")->Args({2000, 1, 14})->UseRealTime();

}  // namespace
}  // namespace suffuse::bench
