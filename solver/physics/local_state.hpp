#pragma once

/// The state of the soil at one place and time: all that a law of physics may depend on.

#include <limits>

namespace suffuse {

/// A value not yet set: using it shows.
inline constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// What the caller does not know stays unset.
struct LocalState {
  double porosity = unset;           ///< n_L
  double erodible_fraction = unset;  ///< n_e
  double skeleton_fraction = unset;  ///< n_C
  double concentration = unset;      ///< c
  double flux = unset;               ///< |q|, m/s
  double drag_gradient = unset;      ///< hydraulic gradient that drag takes up, |q|/k
  double time = unset;               ///< s
};

}  // namespace suffuse
