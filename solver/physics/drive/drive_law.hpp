#pragma once

/// Drives of erosion: the erosion rate grows with the drive above its threshold. Each drive is one
/// file of this folder; docs/develop/contributing.md says how to add one. In unsaturated soil only
/// pores that carry flow erode: drives use k_r i, the gradient that would drive the same flux
/// through the saturated soil (docs/theory/exchange.md, "Erosion").

#include <span>
#include <string_view>

#include "physics/local_state.hpp"

namespace suffuse {

/// A drive of erosion.
struct DriveLaw {
  std::string_view word;       ///< value of `drive` in a scene
  std::string_view equation;   ///< D, for the scene reference
  std::string_view symbol;     ///< its symbol in equations
  std::string_view unit = {};  ///< of the threshold
  /// Unit of `rate`. Rate times drive is in 1/s.
  std::string_view rate_unit;
  /// D depends on the conductivity, and therefore on the porosity.
  bool depends_on_conductivity = false;
  /// D, in `unit`; zero if the liquid is at rest. Null: D = 1, erosion depends on time alone.
  double (*value)(const LocalState& state) = nullptr;

  [[nodiscard]] bool depends_on_flow() const { return value != nullptr; }
};

/// All drives, in the order of physics/CMakeLists.txt and the scene reference. The first, time, is
/// the default.
std::span<const DriveLaw* const> drive_laws();
/// The drive with the name `word`. Throws std::invalid_argument if there is none.
const DriveLaw* drive_law(std::string_view word);

}  // namespace suffuse
