#pragma once

/// Conductivity laws: the dependence of the hydraulic conductivity on porosity and fines. Each law
/// is one file of this folder; docs/develop/contributing.md says how to add one.

#include <limits>
#include <span>
#include <string_view>

namespace suffuse {

struct ConductivityLaw;

/// Parameters of the conductivity laws. A law declares those that it uses.
struct ConductivityParameters {
  double size_ratio = 1.0;  ///< mean size of the coarse grains over that of the fines
  double exponent = std::numeric_limits<double>::quiet_NaN();
};

/// A parameter of a law, read from `[soil.NAME]`. It is required if it has no default.
struct ConductivityParameter {
  std::string_view key;
  std::string_view symbol;
  std::string_view sentence;  ///< for the scene reference
  double ConductivityParameters::*value = nullptr;
  double above = 0.0;  ///< the value is larger than this
};

/// The law of a soil and its parameters.
struct ConductivityModel {
  const ConductivityLaw* law = nullptr;  ///< null: constant
  double conductivity = 0.0;             ///< k_0 at the initial porosity, m/s
  double skeleton_fraction = 0.0;        ///< n_C
  ConductivityParameters parameters = {};

  [[nodiscard]] bool depends_on_porosity() const;
  /// k at `porosity` of soil that had `initial_porosity` when k was k_0, m/s.
  [[nodiscard]] double at(double initial_porosity, double porosity) const;
};

/// A conductivity law.
struct ConductivityLaw {
  std::string_view word;         ///< value of `conductivity_law` in a scene
  std::string_view description;  ///< the dependence on porosity, for the scene reference
  std::span<const ConductivityParameter> parameters = {};
  /// k / k_0. Null: always 1.
  double (*ratio)(const ConductivityModel& model, double initial_porosity,
                  double porosity) = nullptr;

  [[nodiscard]] bool depends_on_porosity() const { return ratio != nullptr; }
};

/// All laws, in the order of physics/CMakeLists.txt and the scene reference. The first is the
/// default.
std::span<const ConductivityLaw* const> conductivity_laws();
/// The law with the name `word`. Throws std::invalid_argument if there is none.
const ConductivityLaw* conductivity_law(std::string_view word);

inline bool ConductivityModel::depends_on_porosity() const {
  return law != nullptr && law->depends_on_porosity();
}

inline double ConductivityModel::at(double initial_porosity, double porosity) const {
  return depends_on_porosity() ? conductivity * law->ratio(*this, initial_porosity, porosity)
                               : conductivity;
}

}  // namespace suffuse
