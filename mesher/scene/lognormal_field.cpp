#include "scene/lognormal_field.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace suffuse {
namespace {

/// Number of waves. With it the sum is Gaussian to a percent three deviations away from its mean.
constexpr int wave_count = 500;

/// Random numbers that are the same with every library: its distributions are not.
class Draws {
 public:
  explicit Draws(int seed) : engine_(static_cast<std::uint64_t>(seed)) {}

  /// Between 0 and 1, neither of them.
  double uniform() { return (static_cast<double>(engine_() >> 12U) + 0.5) * 0x1p-52; }
  /// A number of mean 0 and deviation 1 (Box and Muller).
  double normal() {
    const double size = std::sqrt(-2.0 * std::log(uniform()));
    return size * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace

LognormalField::LognormalField(const FieldModel& model, double bedding)
    : deviation_(std::sqrt(std::log1p(model.variation * model.variation))),
      cosine_(std::cos(bedding * std::numbers::pi / 180.0)),
      sine_(std::sin(bedding * std::numbers::pi / 180.0)) {
  Draws draws(model.seed);
  waves_.reserve(wave_count);
  for (int i = 0; i < wave_count; ++i) {
    // The spectrum of exp(-(r/l)^2) is Gaussian with the deviation sqrt(2)/l.
    const double a = draws.normal() * std::numbers::sqrt2 / model.along;
    const double b = draws.normal() * std::numbers::sqrt2 / model.along;
    const double c = draws.normal() * std::numbers::sqrt2 / model.across;
    waves_.push_back({{a, b, c}, 2.0 * std::numbers::pi * draws.uniform()});
  }
}

double LognormalField::at(double x, double y, double z) const {
  const double along = cosine_ * x + sine_ * z;
  const double across = cosine_ * z - sine_ * x;
  double sum = 0.0;
  for (const Wave& wave : waves_) {
    sum += std::cos(wave.number[0] * along + wave.number[1] * y + wave.number[2] * across +
                    wave.phase);
  }
  const double gaussian = std::sqrt(2.0 / wave_count) * sum;
  return std::exp(deviation_ * (gaussian - 0.5 * deviation_));
}

}  // namespace suffuse
