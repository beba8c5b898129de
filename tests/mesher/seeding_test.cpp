#include "seeding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "case/errors.hpp"

namespace suffuse {
namespace {

/// A scalene triangle and its neighbour.
Mesh<2> two_triangles() {
  Mesh<2> mesh;
  mesh.nodes = {{0, 0}, {3, 0.5}, {1, 2}, {-1, 1.5}};
  mesh.elements = {{0, 1, 2}, {0, 2, 3}};
  mesh.element_region = {0, 0};
  mesh.region_names = {"specimen"};
  return mesh;
}

/// Mean of a^i b^j c^k over a triangle in barycentric coordinates: 2 i! j! k! / (i + j + k + 2)!.
double exact_mean(int i, int j, int k) {
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  return 2.0 * factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 2);
}

double rule_mean(const std::vector<QuadraturePoint<2>>& rule, int i, int j, int k) {
  double sum = 0.0;
  for (const auto& point : rule) {
    const auto& [a, b, c] = point.barycentric;
    sum += point.weight * std::pow(a, i) * std::pow(b, j) * std::pow(c, k);
  }
  return sum;
}

double worst_error(const std::vector<QuadraturePoint<2>>& rule, int degree) {
  double worst = 0.0;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) {
      const int k = degree - i - j;
      worst = std::max(worst, std::abs(rule_mean(rule, i, j, k) - exact_mean(i, j, k)));
    }
  }
  return worst;
}

struct RuleCase {
  int count;
  int degree;
};

class TriangleRule : public testing::TestWithParam<RuleCase> {};

TEST_P(TriangleRule, IntegratesToItsDegreeAndNotBeyond) {
  const auto rule = triangle_rule(GetParam().count);
  ASSERT_EQ(rule.size(), static_cast<std::size_t>(GetParam().count));
  for (int degree = 0; degree <= GetParam().degree; ++degree) {
    EXPECT_LT(worst_error(rule, degree), 4e-16) << "degree " << degree;
  }
  EXPECT_GT(worst_error(rule, GetParam().degree + 1), 1e-7);
}

TEST_P(TriangleRule, HasPositiveWeightsAndInteriorPoints) {
  for (const auto& point : triangle_rule(GetParam().count)) {
    EXPECT_GT(point.weight, 0.0);
    double sum = 0.0;
    for (double share : point.barycentric) {
      EXPECT_GT(share, 0.05);
      sum += share;
    }
    EXPECT_NEAR(sum, 1.0, 4e-16);
  }
}

TEST_P(TriangleRule, FillsEveryElementWithItsVolume) {
  const Mesh<2> mesh = two_triangles();
  PointSettings settings;
  settings.solid_per_element = GetParam().count;
  const MaterialPoints<2> points = seed_solid_points(mesh, settings);
  ASSERT_EQ(points.size(), 2 * GetParam().count);
  std::array<double, 2> volumes{};
  for (int p = 0; p < points.size(); ++p) volumes[points.element[p]] += points.volume[p];
  EXPECT_NEAR(volumes[0], 2.75, 1e-14);  // half the cross product of its edges, by hand
  EXPECT_NEAR(volumes[1], 1.75, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(All, TriangleRule,
                         testing::Values(RuleCase{1, 1}, RuleCase{3, 2}, RuleCase{6, 4},
                                         RuleCase{12, 6}),
                         [](const auto& tested) { return std::to_string(tested.param.count); });

TEST(Seeding, TheThreePointsAreTheInteriorOnes) {
  for (const auto& point : triangle_rule(3)) {
    const double largest = *std::ranges::max_element(point.barycentric);
    EXPECT_DOUBLE_EQ(largest, 2.0 / 3.0);
  }
}

TEST(Seeding, RefusesOtherCounts) {
  EXPECT_THROW(triangle_rule(4), InputError);
}

PointSettings jittered(double jitter, int seed) {
  PointSettings settings;
  settings.solid_per_element = 12;
  settings.jitter = jitter;
  settings.seed = seed;
  return settings;
}

TEST(Jitter, MovesPointsByAtMostItsShareOfTheSizeAndKeepsThemInside) {
  const Mesh<2> mesh = two_triangles();
  const MaterialPoints<2> still = seed_solid_points(mesh, jittered(0.0, 1));
  for (const double jitter : {0.05, 5.0}) {
    const MaterialPoints<2> moved = seed_solid_points(mesh, jittered(jitter, 1));
    EXPECT_EQ(moved.volume, still.volume);
    EXPECT_EQ(moved.element, still.element);
    double farthest = 0.0;
    for (int p = 0; p < moved.size(); ++p) {
      const double size = std::sqrt(2.0 * element_volume(mesh, moved.element[p]));
      const double distance = (moved.position(mesh, p) - still.position(mesh, p)).norm();
      EXPECT_GT(distance, 0.0);
      EXPECT_LE(distance, jitter * size);
      farthest = std::max(farthest, distance / size);
      double sum = 0.0;
      for (double share : moved.barycentric[p]) {
        EXPECT_GT(share, 0.0);
        sum += share;
      }
      EXPECT_NEAR(sum, 1.0, 1e-15);
    }
    EXPECT_GT(farthest, 0.6 * std::min(jitter, 0.4));
  }
}

TEST(Jitter, FollowsTheSeed) {
  const Mesh<2> mesh = two_triangles();
  const auto first = seed_solid_points(mesh, jittered(0.1, 1)).barycentric;
  EXPECT_EQ(seed_solid_points(mesh, jittered(0.1, 1)).barycentric, first);
  EXPECT_NE(seed_solid_points(mesh, jittered(0.1, 2)).barycentric, first);
}

TEST(Jitter, GoesNowhereOnAverage) {
  Mesh<2> mesh = two_triangles();
  PointSettings settings = jittered(0.01, 3);
  Vector<2> mean = Vector<2>::Zero();
  constexpr int runs = 400;
  for (settings.seed = 0; settings.seed < runs; ++settings.seed) {
    const MaterialPoints<2> points = seed_solid_points(mesh, settings);
    mean += points.position(mesh, 0) / runs;
  }
  settings.jitter = 0.0;
  const Vector<2> start = seed_solid_points(mesh, settings).position(mesh, 0);
  const double reach = 0.01 * std::sqrt(2.0 * element_volume(mesh, 0));
  // The deviation of one draw is reach / sqrt(6) per axis.
  EXPECT_LT((mean - start).norm(), 4.0 * reach / std::sqrt(3.0 * runs));
}

}  // namespace
}  // namespace suffuse
