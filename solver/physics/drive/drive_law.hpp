#pragma once

/// What drives erosion: fines leave the faster, the further the drive is above its threshold. Each
/// drive is one file of this folder; docs/contributing.md says how to add one. In unsaturated soil
/// only pores that carry flow erode: drives see k_r i, the gradient that would drive the same flux
/// through the saturated soil (docs/theory.md, "Erosion").

#include <span>
#include <string_view>

#include "physics/local_state.hpp"

namespace suffuse {

/// A drive, as its file declares it.
struct DriveLaw {
  std::string_view word;       ///< what `drive` is in a scene
  std::string_view equation;   ///< D, for the scene reference
  std::string_view symbol;     ///< in equations
  std::string_view unit = {};  ///< of the threshold
  /// Unit of `rate`, so that rate times drive has 1/s.
  std::string_view rate_unit;
  /// D depends on how well the soil conducts, and so on its porosity.
  bool depends_on_conductivity = false;
  /// D, in `unit`; zero where the liquid stands still. Null: erosion goes with time alone, D = 1.
  double (*value)(const LocalState& state) = nullptr;

  [[nodiscard]] bool depends_on_flow() const { return value != nullptr; }
};

/// Every drive there is, in the order of the scene reference: the order in physics/CMakeLists.txt.
/// The first is what a scene has by default: time.
std::span<const DriveLaw* const> drive_laws();
/// The drive that a scene calls `word`. Throws std::invalid_argument where there is none.
const DriveLaw* drive_law(std::string_view word);

}  // namespace suffuse
