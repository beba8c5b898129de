#pragma once

/// Conductivity laws: how the hydraulic conductivity of a soil follows its porosity. Each law is
/// one file of this folder; docs/contributing.md says how to add one.

#include <span>
#include <string_view>

namespace suffuse {

/// A law, as its file declares it.
struct ConductivityLaw {
  std::string_view word;         ///< what `conductivity_law` is in a scene
  std::string_view description;  ///< how conductivity follows porosity, for the scene reference
  /// k / k_0 at `porosity`, k_0 being the conductivity at `initial_porosity`. Null: always 1.
  double (*ratio)(double initial_porosity, double porosity) = nullptr;

  [[nodiscard]] bool depends_on_porosity() const { return ratio != nullptr; }
};

/// Every law there is, in the order of the scene reference: the order in physics/CMakeLists.txt.
/// The first is what a scene has by default.
std::span<const ConductivityLaw* const> conductivity_laws();
/// The law that a scene calls `word`. Throws std::invalid_argument where there is none.
const ConductivityLaw* conductivity_law(std::string_view word);

/// k of a soil whose porosity has gone from `initial_porosity`, where k is `conductivity`, to
/// `porosity`, m/s.
inline double conductivity_at(const ConductivityLaw* law, double conductivity,
                              double initial_porosity, double porosity) {
  return law->ratio == nullptr ? conductivity
                               : conductivity * law->ratio(initial_porosity, porosity);
}

}  // namespace suffuse
