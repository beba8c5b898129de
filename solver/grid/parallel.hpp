#pragma once

/// Loops shared among threads. The body at an index writes to that index only, so results have the
/// same bits on any number of threads. For sources that compile with OpenMP.

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/deadline.hpp"

namespace suffuse {

/// A loop of fewer indices takes less time than waking the threads.
inline constexpr int worth_threads = 4096;

/// One copy of the machine code of a loop, whoever runs it: in two copies the compiler might fuse
/// products and sums differently, and the last bit would differ. (Clang does not clone functions,
/// and does not know the attribute.)
template <class Loop>
#ifdef __clang__
[[gnu::noinline]]
#else
[[gnu::noinline, gnu::noclone]]
#endif
void run_part(const Loop& loop, int begin, int end) {
  loop(begin, end);
}

/// Calls `loop(begin, end)` for parts that together are [0, count). A loop for one thread does not
/// enter OpenMP, which would call the operating system for nothing. Throws DeadlinePassed if the
/// deadline of this thread is over.
template <class Loop>
void share_among(int threads, int count, int worth, const Loop& loop) {
  if (omp_in_parallel() == 0) Deadline::check();
  if (threads <= 1 || count < worth) {
    run_part(loop, 0, count);
    return;
  }
#pragma omp parallel num_threads(threads)
  {
    const long part = omp_get_thread_num();
    const long parts = omp_get_num_threads();
    run_part(loop, static_cast<int>(count * part / parts),
             static_cast<int>(count * (part + 1) / parts));
  }
}

/// Calls `body(i)` for each i in [0, count), on one thread if these are fewer than `worth`.
template <class Body>
void for_each_index(int count, int threads, const Body& body, int worth = worth_threads) {
  share_among(threads, count, worth, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) body(i);
  });
}

/// The largest `value(i)`, or `least` if none is larger; infinity if one is not a number.
/// Independent of the order.
template <class Value>
double largest_of(int count, int threads, double least, const Value& value) {
  double largest = least;
  share_among(threads, count, worth_threads, [&](int begin, int end) {
    double of_part = least;
    for (int i = begin; i < end; ++i) {
      const double v = value(i);
      of_part = std::isnan(v) ? std::numeric_limits<double>::infinity() : std::max(of_part, v);
    }
#pragma omp critical(suffuse_largest_of)
    largest = std::max(largest, of_part);
  });
  return largest;
}

/// The smallest `value(i)`, or `most` if none is smaller; -infinity if one is not a number.
template <class Value>
double smallest_of(int count, int threads, double most, const Value& value) {
  return -largest_of(count, threads, -most, [&](int i) { return -value(i); });
}

}  // namespace suffuse
