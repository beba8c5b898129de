/// The machine itself: bandwidth of the triad in cache and out of it, and a loop without memory
/// access, which shows the largest possible gain by a second thread.

#include "bench/bench.hpp"

namespace suffuse::bench {
namespace {

void Triad(benchmark::State& state) {
  const auto size = static_cast<std::size_t>(state.range(0));
  const auto threads = static_cast<int>(state.range(1));
  std::vector<double> a(size, 1.0);
  const std::vector<double> b(size, 2.0);
  const std::vector<double> c(size, 3.0);
  for ([[maybe_unused]] const auto step : state) triad(a, b, c, threads);
  report(state, static_cast<double>(size), 24.0, threads);
}
BENCHMARK(Triad)
    ->ArgNames({"values", "threads"})
    ->ArgsProduct({{1 << 11, 1 << 14, 1 << 18, 1 << 24}, {1, 2}})
    ->UseRealTime();
BENCHMARK(Triad)->Name("QuickTriad")->Args({1 << 11, 1})->UseRealTime();

/// Chains of multiplications and additions in registers.
void NoMemory(benchmark::State& state) {
  const auto threads = static_cast<int>(state.range(0));
  constexpr int chains = 2;
  constexpr int length = 1 << 20;
  std::array<double, chains> results{};
  for ([[maybe_unused]] const auto step : state) {
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int chain = 0; chain < chains; ++chain) {
      double x = 1.0 + chain;
      for (int i = 0; i < length; ++i) x = x * 0.999999 + 1e-9;
      results.at(chain) = x;
    }
    benchmark::DoNotOptimize(results);
  }
}
BENCHMARK(NoMemory)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
}  // namespace suffuse::bench
