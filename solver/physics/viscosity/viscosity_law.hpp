#pragma once

/// Viscosity laws: how the viscosity of the liquid follows the fines in it. Each law is one file of
/// this folder; docs/contributing.md says how to add one.

#include <span>
#include <string_view>

namespace suffuse {

/// A law, as its file declares it.
struct ViscosityLaw {
  std::string_view word;         ///< what `viscosity_law` is in a scene
  std::string_view description;  ///< for the scene reference
  /// mu / mu_0 at a concentration below `maximum_concentration`. Null: always 1.
  double (*ratio)(double concentration, double maximum_concentration) = nullptr;

  [[nodiscard]] bool depends_on_concentration() const { return ratio != nullptr; }
};

/// The law of the liquid with its number.
struct ViscosityModel {
  const ViscosityLaw* law = nullptr;   ///< null: constant
  double maximum_concentration = 1.0;  ///< c_m, at which the fines lock

  [[nodiscard]] bool depends_on_concentration() const {
    return law != nullptr && law->depends_on_concentration();
  }
  /// mu / mu_0; infinite at c >= c_m. Round-off below zero counts as none.
  [[nodiscard]] double ratio(double concentration) const;
};

/// Every law there is, in the order of the scene reference: the order in physics/CMakeLists.txt.
/// The first is what a scene has by default.
std::span<const ViscosityLaw* const> viscosity_laws();

}  // namespace suffuse
