#pragma once

/// Retention laws: saturation and relative conductivity of a soil under suction. Each law is one
/// file of this folder; docs/develop/contributing.md says how to add one.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

namespace suffuse {

struct RetentionLaw;

/// Parameters of the retention laws. A law declares those that it uses.
struct RetentionParameters {
  double alpha = 0.0;  ///< reciprocal of the suction head at which pores empty, 1/m
  double n = 0.0;      ///< exponent; larger for more uniform pore sizes

  friend bool operator==(const RetentionParameters&, const RetentionParameters&) = default;
};

/// A soil under a pressure head psi.
struct RetentionState {
  double saturation = 1.0;             ///< S; of a law alone: S_e
  double capacity = 0.0;               ///< its slope in psi, 1/m
  double relative_conductivity = 1.0;  ///< k_r, conductivity over that of the saturated soil
  double conductivity_slope = 0.0;     ///< dk_r/dpsi, 1/m
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

  /// The state at a pressure head, m; saturated where psi >= 0.
  [[nodiscard]] RetentionState at(double psi) const;
  /// S_e = (S - S_r) / (1 - S_r), at least 0.
  [[nodiscard]] double effective(double saturation) const {
    return std::max(0.0, (saturation - residual_saturation) / (1.0 - residual_saturation));
  }
  friend bool operator==(const RetentionModel&, const RetentionModel&) = default;
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

/// A retention law. Its functions are called with psi < 0. Much of the time of an iteration in
/// unsaturated soil goes into them, so `at` finds all that a law knows at once.
struct RetentionLaw {
  std::string_view word;         ///< value of `model` in a scene
  std::string_view description;  ///< S_e and k_r, for the scene reference
  std::span<const RetentionParameter> parameters;
  /// S_e, k_r and their slopes.
  RetentionState (*at)(const RetentionParameters& parameters, double psi);
  /// psi at which dS_e/dpsi is largest, m; below 0.
  double (*steepest)(const RetentionParameters& parameters);
};

/// All laws, in the order of physics/CMakeLists.txt and the scene reference.
std::span<const RetentionLaw* const> retention_laws();
/// The law with the name `word`. Throws std::invalid_argument if there is none.
const RetentionLaw* retention_law(std::string_view word);

/// Pores of which one state has the share `share`, and the other the rest.
inline RetentionState mixture(const RetentionState& rest, const RetentionState& one, double share) {
  return {std::lerp(rest.saturation, one.saturation, share),
          std::lerp(rest.capacity, one.capacity, share),
          std::lerp(rest.relative_conductivity, one.relative_conductivity, share),
          std::lerp(rest.conductivity_slope, one.conductivity_slope, share)};
}

inline RetentionState RetentionModel::at(double psi) const {
  if (law == nullptr || psi >= 0.0) return {};
  RetentionState state = law->at(parameters, psi);
  const double held = 1.0 + (psi / dries_at) * (psi / dries_at);
  const double dried = -2.0 * residual_saturation * psi / (dries_at * dries_at * held * held);
  state.saturation = residual_saturation / held + (1.0 - residual_saturation) * state.saturation;
  state.capacity = dried + (1.0 - residual_saturation) * state.capacity;
  return state;
}

}  // namespace suffuse
