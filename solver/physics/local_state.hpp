#pragma once

/// The state of soil and liquid at one place and time: all that a law may depend on.

#include <limits>

namespace suffuse {

/// NaN marks a value that is not set; results that use it become NaN.
inline constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// Values that the caller does not know stay unset.
struct LocalState {
  double porosity = unset;           ///< n_L
  double erodible_fraction = unset;  ///< n_e minus the residual
  double concentration = unset;      ///< c
  double flux = unset;               ///< |q|, m/s
  /// i, hydraulic gradient that balances drag; in unsaturated soil k_r i.
  double drag_gradient = unset;
  double permeability = unset;  ///< kappa, m2
  double unit_weight = unset;   ///< rho_w g of the water, N/m3
};

}  // namespace suffuse
