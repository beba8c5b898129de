#pragma once

/// Heads: pressures as heights of water above the origin.

#include <array>
#include <cmath>

#include "physics/drag.hpp"

namespace suffuse {

inline bool has_gravity(const std::array<double, 3>& gravity) {
  return gravity[0] != 0.0 || gravity[1] != 0.0 || gravity[2] != 0.0;
}

/// |g|, m/s2.
inline double acceleration(const std::array<double, 3>& gravity) {
  return std::hypot(gravity[0], gravity[1], gravity[2]);
}

/// rho_w |g|, Pa/m; without gravity heads are excess heads and |g| is `conductivity_gravity`.
inline double unit_weight(double water_density, const std::array<double, 3>& gravity) {
  const double g = acceleration(gravity);
  return water_density * (g > 0.0 ? g : conductivity_gravity);
}

/// z = -x . g / |g|, m, exact if gravity is along an axis; 0 without gravity. `x`: a position of 2
/// or 3 coordinates.
template <class Position>
double height(const Position& x, const std::array<double, 3>& gravity) {
  const double g = acceleration(gravity);
  if (!(g > 0.0)) return 0.0;
  double z = 0.0;
  for (int d = 0; d < static_cast<int>(x.size()); ++d) z += x[d] * (-gravity[d] / g);
  return z;
}

}  // namespace suffuse
