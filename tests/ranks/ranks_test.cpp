/// What ranks send each other: sums, largest values, counts.

#include "ranks/mpi_ranks.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace suffuse {
namespace ranks_test {

/// Sums over all ranks have the bits of a sum by one process.
TEST(Ranks, SumExactly) {
  const auto ranks = mpi_ranks();
  std::mt19937_64 random(5);
  ExactSum whole;
  ExactSum of_rank;
  ExactSum count;
  for (int i = 0; i < 10000; ++i) {
    const double mantissa = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
    const double term = std::ldexp(mantissa, static_cast<int>(random() % 100) - 50);
    whole.add(term);
    if (i % ranks->count() == ranks->rank()) of_rank.add(term);
  }
  count.add(1.0);
  ranks->sum({&of_rank, &count});
  EXPECT_EQ(of_rank.value(), whole.value());
  EXPECT_EQ(count.value(), ranks->count());
}

TEST(Ranks, FindTheLargest) {
  const auto ranks = mpi_ranks();
  std::array<double, 2> values{1.0 * ranks->rank(), -1.0 * ranks->rank()};
  ranks->largest(values);
  EXPECT_EQ(values[0], ranks->count() - 1.0);
  EXPECT_EQ(values[1], 0.0);
}

TEST(Ranks, CountThoseBefore) {
  const auto ranks = mpi_ranks();
  EXPECT_EQ(ranks->before(10), 10L * ranks->rank());
}

}  // namespace ranks_test
}  // namespace suffuse
