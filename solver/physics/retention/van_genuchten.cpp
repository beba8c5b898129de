/// S_e of van Genuchten (Soil Sci. Soc. Am. J. 44 (1980) 892) with m = 1 - 1/n, and k_r of Mualem
/// (Water Resour. Res. 12 (1976) 513).

#include <array>
#include <cmath>

#include "physics/retention/retention_law.hpp"

namespace suffuse::retention {
namespace {

/// For n < 2 Mualem's k_r has an infinite slope at psi = 0, due to unrealistically large pores. k_r
/// is therefore linear up to this suction head, m (Vogel, van Genuchten and Cislerova, Adv. Water
/// Resour. 24 (2001) 133, who also modify S_e).
constexpr double smallest_suction = 0.02;

RetentionState at(const RetentionParameters& p, double psi) {
  const double m = 1.0 - 1.0 / p.n;
  // x = (-alpha psi)^n. Only exp(-|log x|) neither overflows nor loses digits, in wet soil and dry.
  const double log_x = p.n * std::log(-p.alpha * psi);
  const bool is_dry = log_x > 0.0;
  const double small = std::exp(is_dry ? -log_x : log_x);
  const double of_small = std::log1p(small);
  const double log_wet = is_dry ? log_x + of_small : of_small;  // of 1 + x
  const double log_dry = is_dry ? of_small : of_small - log_x;  // of 1 + 1/x
  const double dry = (is_dry ? 1.0 : small) / (1.0 + small);    // x / (1 + x)
  const double wet = (is_dry ? small : 1.0) / (1.0 + small);    // 1 / (1 + x)
  const double per_psi = -m * p.n / psi;
  RetentionState state{.saturation = std::exp(-m * log_wet)};
  state.capacity = per_psi * dry * state.saturation;
  const double opened = -std::expm1(-m * log_dry);  // 1 - (1 - S_e^(1/m))^m
  const double root = std::sqrt(state.saturation);
  state.relative_conductivity = root * opened * opened;
  state.conductivity_slope =
      per_psi * root * opened * (0.5 * dry * opened + 2.0 * (1.0 - opened) * wet);
  if (p.n < 2.0 && psi > -smallest_suction) {
    const double there = at(p, -smallest_suction).relative_conductivity;
    state.conductivity_slope = (1.0 - there) / smallest_suction;
    state.relative_conductivity = 1.0 + state.conductivity_slope * psi;
  }
  return state;
}

double steepest(const RetentionParameters& p) {
  return -std::pow(1.0 - 1.0 / p.n, 1.0 / p.n) / p.alpha;
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
    .at = at,
    .steepest = steepest};

}  // namespace suffuse::retention
