/// S_e of van Genuchten (Soil Sci. Soc. Am. J. 44 (1980) 892) with m = 1 - 1/n, and k_r of Mualem
/// (Water Resour. Res. 12 (1976) 513).

#include <array>
#include <cmath>

#include "physics/retention/retention_law.hpp"

namespace suffuse::retention {
namespace {

double saturation(const RetentionParameters& p, double psi) {
  return std::pow(1.0 + std::pow(-p.alpha * psi, p.n), -(1.0 - 1.0 / p.n));
}

double capacity(const RetentionParameters& p, double psi) {
  const double m = 1.0 - 1.0 / p.n;
  const double power = std::pow(-p.alpha * psi, p.n);
  return m * p.n * (power / -psi) * std::pow(1.0 + power, -m - 1.0);
}

double steepest(const RetentionParameters& p) {
  return -std::pow(1.0 - 1.0 / p.n, 1.0 / p.n) / p.alpha;
}

/// For n < 2 Mualem's k_r has an infinite slope at psi = 0, due to unrealistically large pores. k_r
/// is therefore linear up to this suction head, m (Vogel, van Genuchten and Cislerova, Adv. Water
/// Resour. 24 (2001) 133, who also modify S_e).
constexpr double smallest_suction = 0.02;

double relative_conductivity(const RetentionParameters& p, double psi) {
  if (p.n < 2.0 && psi > -smallest_suction) {
    const double there = relative_conductivity(p, -smallest_suction);
    return 1.0 + (1.0 - there) * psi / smallest_suction;
  }
  const double m = 1.0 - 1.0 / p.n;
  const double power = std::pow(-p.alpha * psi, p.n);
  // 1 - (1 - S_e^(1/m))^m with S_e^(1/m) = 1 / (1 + power), without cancellation in dry soil.
  const double opened = -std::expm1(-m * std::log1p(1.0 / power));
  return std::sqrt(std::pow(1.0 + power, -m)) * opened * opened;
}

constexpr std::array parameters{
    RetentionParameter{"alpha", "alpha", "1/m",
                       "Reciprocal of the suction head at which the pores empty.", 0.0,
                       &RetentionParameters::alpha},
    RetentionParameter{"n", "n", "", "How narrow the distribution of pore sizes is.", 1.0,
                       &RetentionParameters::n}};

}  // namespace

extern const RetentionLaw van_genuchten{
    .word = "van-genuchten",
    .description =
        "S_e = (1 + (-alpha psi)^n)^(-m) with m = 1 - 1/n and k_r = S_e^(1/2) (1 - (1 - "
        "S_e^(1/m))^m)^2",
    .parameters = parameters,
    .saturation = saturation,
    .capacity = capacity,
    .steepest = steepest,
    .relative_conductivity = relative_conductivity};

}  // namespace suffuse::retention
