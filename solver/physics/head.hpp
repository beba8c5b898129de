#pragma once

/// Heads: pressures as heights of water, above a datum at the origin.

#include <array>
#include <cmath>

namespace suffuse {

/// rho_w |g|, Pa/m; without gravity a head is an excess head of rho_w 9.81.
inline double unit_weight(double water_density, const std::array<double, 3>& gravity) {
  const double g = std::hypot(gravity[0], gravity[1], gravity[2]);
  return water_density * (g > 0.0 ? g : 9.81);
}

/// z = -x . g / |g|, m; 0 without gravity. `x`: a position of 2 or 3 coordinates.
template <class Position>
double height(const Position& x, const std::array<double, 3>& gravity) {
  const double g = std::hypot(gravity[0], gravity[1], gravity[2]);
  if (!(g > 0.0)) return 0.0;
  double along = 0.0;
  for (int d = 0; d < static_cast<int>(x.size()); ++d) along += x[d] * gravity[d];
  return -along / g;
}

}  // namespace suffuse
