#pragma once

/// Limit states of hydraulic heave (HYD) and uplift (UPL) of EN 1997-1:2004 for a column of soil.

#include "scene/check_settings.hpp"

namespace suffuse {

/// A column from the ground down to a depth. Free water on the ground presses on both sides of an
/// inequality alike; it is in neither.
struct ColumnLoads {
  double depth = 0.0;          ///< m
  double pressure = 0.0;       ///< u at the base, Pa
  double total_stress = 0.0;   ///< sigma at the base, Pa
  double seepage_force = 0.0;  ///< S, upwards, per area: u above the hydrostatic pressure, N/m2
  double weight = 0.0;         ///< G', submerged, per area, N/m2
};

/// An effect of actions and the resistance to it, with their partial factors.
struct Utilisation {
  double effect = 0.0;
  double resistance = 0.0;

  /// Below 1 the limit state is passed. Infinite where nothing acts.
  [[nodiscard]] double factor() const;
};

/// 2.9a: gamma_dst u <= gamma_stb sigma, Pa.
Utilisation heave_by_stresses(const ColumnLoads& column, const PartialFactors& factors);
/// 2.9b: gamma_dst S <= gamma_stb G', N/m2.
Utilisation heave_by_forces(const ColumnLoads& column, const PartialFactors& factors);
/// 2.8: gamma_dst u <= gamma_stb sigma at the base of a cover, Pa, without friction at its sides.
Utilisation uplift(const ColumnLoads& column, const PartialFactors& factors);

}  // namespace suffuse
