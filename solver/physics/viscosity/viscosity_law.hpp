#pragma once

/// Viscosity laws: the dependence of the liquid's viscosity on its fines. Each law is one file of
/// this folder; docs/develop/contributing.md says how to add one.

#include <span>
#include <string_view>

namespace suffuse {

/// A viscosity law.
struct ViscosityLaw {
  std::string_view word;         ///< value of `viscosity_law` in a scene
  std::string_view description;  ///< for the scene reference
  /// mu / mu_0 at a concentration below `maximum_concentration`. Null: always 1.
  double (*ratio)(double concentration, double maximum_concentration) = nullptr;

  [[nodiscard]] bool depends_on_concentration() const { return ratio != nullptr; }
};

/// The law of the liquid and its parameter.
struct ViscosityModel {
  const ViscosityLaw* law = nullptr;   ///< null: constant
  double maximum_concentration = 1.0;  ///< c_m, at which the fines lock

  [[nodiscard]] bool depends_on_concentration() const {
    return law != nullptr && law->depends_on_concentration();
  }
  /// mu / mu_0; infinite at c >= c_m. Negative c counts as zero.
  [[nodiscard]] double ratio(double concentration) const;
};

/// All laws, in the order of physics/CMakeLists.txt and the scene reference. The first is the
/// default.
std::span<const ViscosityLaw* const> viscosity_laws();

}  // namespace suffuse
