#pragma once

/// Retention laws: saturation and relative conductivity of a soil under suction. Each law is one
/// file of this folder; docs/develop/contributing.md says how to add one.

#include <algorithm>
#include <limits>
#include <span>
#include <string_view>

namespace suffuse {

struct RetentionLaw;

/// Parameters of the retention laws. A law declares those that it uses.
struct RetentionParameters {
  double alpha = 0.0;  ///< reciprocal of the suction head at which pores empty, 1/m
  double n = 0.0;      ///< exponent; larger for more uniform pore sizes
};

/// The law of a soil and its parameters. The pressure head psi = p / (rho_w g), m, is negative
/// under suction. S = S_r + (1 - S_r) S_e is the liquid per pore volume.
struct RetentionModel {
  const RetentionLaw* law = nullptr;  ///< null: saturated at any pressure
  double residual_saturation = 0.0;   ///< S_r
  RetentionParameters parameters = {};
  /// Suction head at which half of the residual saturation is lost, m. Soil that moves can fall
  /// below the residual saturation when its pores open.
  double dries_at = std::numeric_limits<double>::infinity();

  /// S; 1 where psi >= 0.
  [[nodiscard]] double saturation(double psi) const;
  /// dS/dpsi, 1/m; 0 where psi >= 0.
  [[nodiscard]] double capacity(double psi) const;
  /// k_r, conductivity over that of the saturated soil; 1 where psi >= 0.
  [[nodiscard]] double relative_conductivity(double psi) const;
  /// S_e = (S - S_r) / (1 - S_r), at least 0.
  [[nodiscard]] double effective(double saturation) const {
    return std::max(0.0, (saturation - residual_saturation) / (1.0 - residual_saturation));
  }
};

/// A required parameter of a law, read from `[soil.NAME.retention]`.
struct RetentionParameter {
  std::string_view key;
  std::string_view symbol;
  std::string_view unit;
  std::string_view sentence;  ///< for the scene reference
  double above;               ///< the value is larger than this
  double RetentionParameters::*value = nullptr;
};

/// A retention law. Its functions are called with psi < 0.
struct RetentionLaw {
  std::string_view word;         ///< value of `model` in a scene
  std::string_view description;  ///< S_e and k_r, for the scene reference
  std::span<const RetentionParameter> parameters;
  /// S_e
  double (*saturation)(const RetentionParameters& parameters, double psi);
  /// dS_e/dpsi, 1/m
  double (*capacity)(const RetentionParameters& parameters, double psi);
  /// psi at which dS_e/dpsi is largest, m; below 0.
  double (*steepest)(const RetentionParameters& parameters);
  /// k_r
  double (*relative_conductivity)(const RetentionParameters& parameters, double psi);
};

/// All laws, in the order of physics/CMakeLists.txt and the scene reference.
std::span<const RetentionLaw* const> retention_laws();
/// The law with the name `word`. Throws std::invalid_argument if there is none.
const RetentionLaw* retention_law(std::string_view word);

inline double RetentionModel::saturation(double psi) const {
  if (law == nullptr || psi >= 0.0) return 1.0;
  const double retained = residual_saturation / (1.0 + (psi / dries_at) * (psi / dries_at));
  return retained + (1.0 - residual_saturation) * law->saturation(parameters, psi);
}

inline double RetentionModel::capacity(double psi) const {
  if (law == nullptr || psi >= 0.0) return 0.0;
  const double held = 1.0 + (psi / dries_at) * (psi / dries_at);
  const double dried = -2.0 * residual_saturation * psi / (dries_at * dries_at * held * held);
  return dried + (1.0 - residual_saturation) * law->capacity(parameters, psi);
}

inline double RetentionModel::relative_conductivity(double psi) const {
  if (law == nullptr || psi >= 0.0) return 1.0;
  return law->relative_conductivity(parameters, psi);
}

}  // namespace suffuse
