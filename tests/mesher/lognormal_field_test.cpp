/// A conductivity that varies at random: its moments and its correlation over many draws.

#include "scene/lognormal_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace suffuse {
namespace lognormal_field_test {

constexpr int draws = 2000;
constexpr double errors = 3.0;  // standard errors within which an estimate must lie

/// The Gaussian variable (ln k - mean)/deviation of each draw at a place.
std::vector<double> gaussians(const FieldModel& model, double bedding, double x, double z) {
  const double deviation = std::sqrt(std::log1p(model.variation * model.variation));
  std::vector<double> values;
  values.reserve(draws);
  for (int i = 0; i < draws; ++i) {
    FieldModel draw = model;
    draw.seed = 1000 + i;
    const double k = LognormalField(draw, bedding).at(x, 0.0, z);
    values.push_back((std::log(k) + 0.5 * deviation * deviation) / deviation);
  }
  return values;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (int i = 0; i < draws; ++i) sum += a[i] * b[i];
  return sum / draws;
}

double mean(const std::vector<double>& a) {
  return mean_product(a, std::vector<double>(draws, 1.0));
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto covariance = [](const auto& u, const auto& v) {
    return mean_product(u, v) - mean(u) * mean(v);
  };
  return covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
}

const FieldModel model{.variation = 0.5, .along = 4.0, .across = 1.0};

/// Standard errors: 1/sqrt(N) of the mean, sqrt(2/N) of the variance.
TEST(LognormalField, MeanAndVarianceOfManyDraws) {
  for (const double x : {0.0, 3.0, 250.0}) {
    const std::vector<double> g = gaussians(model, 0.0, x, -0.5 * x);
    EXPECT_NEAR(mean(g), 0.0, errors / std::sqrt(draws)) << x;
    EXPECT_NEAR(mean_product(g, g), 1.0, errors * std::sqrt(2.0 / draws)) << x;
  }
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < draws; ++i) {
    FieldModel draw = model;
    draw.seed = i;
    const double k = LognormalField(draw, 0.0).at(1.0, 2.0, 3.0);
    sum += k / draws;
    squares += k * k / draws;
  }
  EXPECT_NEAR(sum, 1.0, errors * model.variation / std::sqrt(draws));
  const double variance = squares - sum * sum;
  // The standard error of a variance needs the fourth moment; of a lognormal variable with this
  // variation the kurtosis is 8.04.
  const double squared = model.variation * model.variation;
  EXPECT_NEAR(variance, squared, errors * squared * std::sqrt((8.04 - 1.0) / draws));
}

/// exp(-(r/l)^2) along and across bedding, which is turned by 30 degrees; the standard error is
/// (1 - rho^2)/sqrt(N).
TEST(LognormalField, CorrelationAlongAndAcrossBedding) {
  const double c = std::cos(M_PI / 6.0);
  const double s = 0.5;
  const std::vector<double> here = gaussians(model, 30.0, 0.0, 0.0);
  for (const double share : {0.25, 0.5, 1.0, 3.0}) {
    const double expected = std::exp(-share * share);
    const double error = errors * (1.0 - expected * expected) / std::sqrt(draws);
    const double a = share * model.along;
    EXPECT_NEAR(correlation(here, gaussians(model, 30.0, a * c, a * s)), expected, error) << share;
    const double b = share * model.across;
    EXPECT_NEAR(correlation(here, gaussians(model, 30.0, -b * s, b * c)), expected, error) << share;
  }
}

TEST(LognormalField, ASeedIsADraw) {
  const LognormalField first(model, 0.0);
  const LognormalField again(model, 0.0);
  FieldModel other = model;
  other.seed = 2;
  EXPECT_EQ(first.at(1.0, 2.0, 3.0), again.at(1.0, 2.0, 3.0));
  EXPECT_NE(first.at(1.0, 2.0, 3.0), LognormalField(other, 0.0).at(1.0, 2.0, 3.0));
  const std::array<double, 2> plane{1.0, 3.0};
  EXPECT_EQ(first.at(plane), first.at(1.0, 0.0, 3.0));
}

}  // namespace lognormal_field_test
}  // namespace suffuse
