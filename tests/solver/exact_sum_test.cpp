/// Exact sums: the value is the rounded sum of the terms, in any order and in any parts.

#include "ranks/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "results/state_archive.hpp"

namespace suffuse {
namespace exact_sum_test {

double sum(const std::vector<double>& terms) {
  ExactSum result;
  for (const double term : terms) result.add(term);
  return result.value();
}

/// Terms of both signs over 300 decades.
std::vector<double> random_terms(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<double> terms;
  for (int i = 0; i < count; ++i) {
    const double mantissa = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
    terms.push_back(std::ldexp(mantissa, static_cast<int>(random() % 1000) - 500));
  }
  return terms;
}

TEST(ExactSum, OfOneTermIsTheTerm) {
  using Limits = std::numeric_limits<double>;
  for (const double term : {0.0, 1.0, -1.0, 0.1, -1e300, 1e-300, Limits::max(), -Limits::max(),
                            Limits::min(), Limits::denorm_min(), 3.0 * Limits::denorm_min()}) {
    EXPECT_EQ(sum({term}), term);
    EXPECT_EQ(sum({term, -term}), 0.0);
  }
  for (const double term : random_terms(10000, 1)) ASSERT_EQ(sum({term}), term);
}

TEST(ExactSum, KeepsWhatAPlainSumLoses) {
  EXPECT_EQ(sum({1e300, 1.0, -1e300}), 1.0);
  EXPECT_EQ(sum({1e300, 1e-300, -1e300, -1e-300}), 0.0);
  std::vector<double> terms{1e16};
  terms.insert(terms.end(), 5000, 0.25);
  terms.push_back(-1e16);
  EXPECT_EQ(sum(terms), 1250.0);
}

/// To even where a sum lies in the middle of two numbers, and to the right one next to it.
TEST(ExactSum, RoundsToTheNearest) {
  const double next = 1.0 + 0x1p-52;
  EXPECT_EQ(sum({1.0, 0x1p-53}), 1.0);
  EXPECT_EQ(sum({next, 0x1p-53}), 1.0 + 0x1p-51);
  EXPECT_EQ(sum({1.0, 0x1p-53, 1e-300}), next);
  EXPECT_EQ(sum({1.0, 0x1p-53, -1e-300}), 1.0);
  EXPECT_EQ(sum({-1.0, -0x1p-53, -1e-300}), -next);
}

TEST(ExactSum, IsNearALongDoubleSum) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> terms;
    long double expected = 0.0L;
    for (int i = 0; i < 3000; ++i) {
      terms.push_back(static_cast<double>(random() >> 11) * 0x1p-40 - 4096.0);
      expected += terms.back();  // exact: multiples of 2^-40 below 2^24
    }
    ASSERT_EQ(sum(terms), static_cast<double>(expected));
  }
}

TEST(ExactSum, HasTheSameBitsInAnyOrderAndParts) {
  std::vector<double> terms = random_terms(20000, 3);
  const double expected = sum(terms);
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 5; ++trial) {
    std::ranges::shuffle(terms, random);
    std::vector<ExactSum> parts(1 + trial);
    for (std::size_t i = 0; i < terms.size(); ++i) parts[i % parts.size()].add(terms[i]);
    ExactSum whole;
    for (const ExactSum& part : parts) whole.add(part);
    ASSERT_EQ(whole.value(), expected);
    // The state of a sum depends on its value alone.
    ExactSum again;
    again.add(terms[0]);
    for (std::size_t i = 1; i < terms.size(); ++i) again.add(terms[i]);
    StateArchive one;
    StateArchive other;
    one(whole);
    other(again);
    ASSERT_EQ(one.finish(), other.finish());
  }
}

TEST(ExactSum, OfTwoSumsTheDifferenceIsExact) {
  ExactSum a;
  ExactSum b;
  a.add(1e20);
  a.add(1e-5);
  b.add(1e20);
  EXPECT_EQ(a.minus(b), 1e-5);
  EXPECT_EQ(b.minus(a), -1e-5);
  EXPECT_EQ(a.minus(a), 0.0);
}

TEST(ExactSum, IsNotFiniteIfATermIsNot) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sum({1.0, infinite}), infinite);
  EXPECT_TRUE(std::isnan(sum({infinite, -infinite})));
  EXPECT_TRUE(std::isnan(sum({1.0, std::nan("")})));
}

}  // namespace exact_sum_test
}  // namespace suffuse
