#pragma once

/// The state of the soil and of the liquid in it at one place and time: all that a law of physics
/// may depend on.

#include <limits>

namespace suffuse {

/// A value not yet set: using it shows.
inline constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// What the caller does not know stays unset.
struct LocalState {
  double porosity = unset;           ///< n_L
  double erodible_fraction = unset;  ///< n_e, without the residual that stays
  double concentration = unset;      ///< c
  double flux = unset;               ///< |q|, m/s
  /// i, hydraulic gradient that drag takes up; in unsaturated soil k_r i.
  double drag_gradient = unset;
  double permeability = unset;  ///< kappa, m2
  double unit_weight = unset;   ///< rho_w g of the water, N/m3
};

}  // namespace suffuse
