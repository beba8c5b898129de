#pragma once

/// Conductivity laws: how the hydraulic conductivity of a soil follows its porosity and its fines.
/// Each law is one file of this folder; docs/contributing.md says how to add one.

#include <limits>
#include <span>
#include <string_view>

namespace suffuse {

struct ConductivityLaw;

/// Numbers that some conductivity laws ask for. A law declares those that it uses.
struct ConductivityParameters {
  double size_ratio = 1.0;  ///< mean size of the coarse grains over that of the fines
  double exponent = std::numeric_limits<double>::quiet_NaN();
};

/// A number that a law asks the scene for, under `[soil.NAME]`. Without a default the law's
/// soils must have it.
struct ConductivityParameter {
  std::string_view key;
  std::string_view symbol;
  std::string_view sentence;  ///< for the scene reference
  double ConductivityParameters::*value = nullptr;
  double above = 0.0;  ///< the value is larger than this
};

/// One soil's law with its numbers.
struct ConductivityModel {
  const ConductivityLaw* law = nullptr;  ///< null: constant
  double conductivity = 0.0;             ///< k_0 at the initial porosity, m/s
  double skeleton_fraction = 0.0;        ///< n_C
  ConductivityParameters parameters = {};

  [[nodiscard]] bool depends_on_porosity() const;
  /// k at `porosity` of soil that had `initial_porosity` when k was k_0, m/s.
  [[nodiscard]] double at(double initial_porosity, double porosity) const;
};

/// A law, as its file declares it.
struct ConductivityLaw {
  std::string_view word;         ///< what `conductivity_law` is in a scene
  std::string_view description;  ///< how conductivity follows porosity, for the scene reference
  std::span<const ConductivityParameter> parameters = {};
  /// k / k_0. Null: always 1.
  double (*ratio)(const ConductivityModel& model, double initial_porosity,
                  double porosity) = nullptr;

  [[nodiscard]] bool depends_on_porosity() const { return ratio != nullptr; }
};

/// Every law there is, in the order of the scene reference: the order in physics/CMakeLists.txt.
/// The first is what a scene has by default.
std::span<const ConductivityLaw* const> conductivity_laws();
/// The law that a scene calls `word`. Throws std::invalid_argument where there is none.
const ConductivityLaw* conductivity_law(std::string_view word);

inline bool ConductivityModel::depends_on_porosity() const {
  return law != nullptr && law->depends_on_porosity();
}

inline double ConductivityModel::at(double initial_porosity, double porosity) const {
  return depends_on_porosity() ? conductivity * law->ratio(*this, initial_porosity, porosity)
                               : conductivity;
}

}  // namespace suffuse
