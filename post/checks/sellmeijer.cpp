#include "checks/sellmeijer.hpp"

#include <cmath>
#include <numbers>

#include "files/number_text.hpp"

namespace suffuse {
namespace {

constexpr double white = 0.25;                                     // eta, White's coefficient
constexpr double bedding_angle = 37.0 / 180.0 * std::numbers::pi;  // theta
constexpr double mean_d70 = 2.08e-4;                               // m, of the small tests
// Means of the tests, which the powers below are fitted about.
constexpr PipingLayer mean_of_tests{};

double resistance_factor(const PipingLayer& layer) {
  return white * layer.relative_weight * std::tan(bedding_angle) *
         std::pow(layer.relative_density / mean_of_tests.relative_density, 0.35) *
         std::pow(layer.uniformity / mean_of_tests.uniformity, 0.13) *
         std::pow(layer.roundness / mean_of_tests.roundness, -0.02);
}

double scale_factor(const PipingLayer& layer) {
  const double factor = layer.d70 / std::cbrt(layer.permeability * layer.length);
  return layer.grain_size_correction ? factor * std::pow(mean_d70 / layer.d70, 0.6) : factor;
}

double geometry_factor(const PipingLayer& layer) {
  const double ratio = layer.thickness / layer.length;
  // At D = L the exponent has no bound, and the power tends to e^(0.28/2.8) of 1.
  if (std::abs(ratio - 1.0) < 1e-9) return 0.91 * std::exp(0.1);
  return 0.91 * std::pow(ratio, 0.28 / (std::pow(ratio, 2.8) - 1.0) + 0.04);
}

}  // namespace

double critical_head(const PipingLayer& layer) {
  return layer.length * resistance_factor(layer) * scale_factor(layer) * geometry_factor(layer);
}

std::vector<std::string> outside_tests(const PipingLayer& layer) {
  std::vector<std::string> sentences;
  const auto expect = [&](const char* name, double value, double low, double high,
                          const char* unit) {
    if (value >= low && value <= high) return;
    sentences.push_back(std::string(name) + " = " + short_text(value) + unit + "; the tests had " +
                        short_text(low) + " to " + short_text(high) + unit);
  };
  expect("d70", 1e3 * layer.d70, 0.15, 0.43, " mm");
  expect("U", layer.uniformity, 1.3, 2.6, "");
  expect("KAS", layer.roundness, 35.0, 70.0, " %");
  expect("RD", layer.relative_density, 34.0, 100.0, " %");
  return sentences;
}

}  // namespace suffuse
