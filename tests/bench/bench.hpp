#pragma once

/// Counters of every micro-benchmark: time per point, bytes moved per point according to the sizes
/// of its arrays, and the share of the bandwidth that a plain triad reaches in the same program.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <vector>

namespace suffuse::bench {

/// a = b + s c, the loop of STREAM; 24 bytes per value, write-allocation not counted.
inline void triad(std::vector<double>& a, const std::vector<double>& b,
                  const std::vector<double>& c, int threads) {
  const auto size = static_cast<long>(a.size());
#pragma omp parallel for schedule(static) num_threads(threads)
  for (long i = 0; i < size; ++i) a[i] = b[i] + 3.0 * c[i];
  benchmark::DoNotOptimize(a.data());
  benchmark::ClobberMemory();
}

/// Bytes per second of the triad over arrays that no cache holds, best of some runs; measured once
/// per number of threads (1 or 2).
inline double triad_bandwidth(int threads) {
  static std::array<double, 3> measured{};
  double& best = measured.at(threads);
  if (best > 0.0) return best;
  constexpr std::size_t size = 16 << 20;
  std::vector<double> a(size, 1.0);
  const std::vector<double> b(size, 2.0);
  const std::vector<double> c(size, 3.0);
  for (int run = 0; run < 8; ++run) {
    const auto start = std::chrono::steady_clock::now();
    triad(a, b, c, threads);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    best = std::max(best, 24.0 * static_cast<double>(size) / taken.count());
  }
  return best;
}

/// Counters of a benchmark whose iteration handles `points` points and moves `bytes` per point.
/// Register it with `UseRealTime()`.
inline void report(benchmark::State& state, double points, double bytes, int threads) {
  using benchmark::Counter;
  constexpr auto per_iteration = Counter::kIsIterationInvariantRate;
  state.counters["points"] = points;
  state.counters["s_per_point"] = Counter(points, per_iteration | Counter::kInvert);
  state.counters["bytes_per_point"] = bytes;
  state.counters["of_triad"] = Counter(points * bytes / triad_bandwidth(threads), per_iteration);
}

}  // namespace suffuse::bench
