/// What ranks send each other: sums, largest values, counts.

#include "ranks/mpi_ranks.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "common/errors.hpp"

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

/// What one rank throws, all throw.
TEST(Ranks, FailTogether) {
  const auto ranks = mpi_ranks();
  const int last = ranks->count() - 1;
  const auto fail = [&](const auto& error) {
    together(*ranks, [&] {
      if (ranks->rank() == last) throw error;
    });
  };
  const auto expect = [&](const auto& error) {
    using Error = std::decay_t<decltype(error)>;
    try {
      fail(error);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& caught) {
      EXPECT_STREQ(caught.what(), error.what());
    }
  };
  expect(NumericalError("no step was found"));
  expect(FileError("history.csv: cannot be written"));
  expect(InputError(InputProblem{"scene.toml:3", "time.end", "nothing", "a time", ""}));
  EXPECT_NO_THROW(together(*ranks, [] {}));
}

TEST(Ranks, TellTheFirstText) {
  const auto ranks = mpi_ranks();
  const int last = ranks->count() - 1;
  EXPECT_EQ(ranks->first_text("rank " + std::to_string(ranks->rank())), "rank 0");
  EXPECT_EQ(ranks->first_text(ranks->rank() == last ? "the last" : ""), "the last");
  EXPECT_EQ(ranks->first_text(""), "");
  EXPECT_EQ(is_first(*ranks, ranks->rank() == last), ranks->rank() == last);
  EXPECT_EQ(is_first(*ranks, true), ranks->rank() == 0);
}

TEST(Ranks, GatherInTheirOrder) {
  const auto ranks = mpi_ranks();
  // Rank r has r values.
  const std::vector<int> own(static_cast<std::size_t>(ranks->rank()), ranks->rank());
  std::vector<int> all;
  for (int r = 0; r < ranks->count(); ++r) all.insert(all.end(), static_cast<std::size_t>(r), r);
  EXPECT_EQ(gather_values(*ranks, own), ranks->rank() == 0 ? all : std::vector<int>());
}

}  // namespace ranks_test
}  // namespace suffuse
