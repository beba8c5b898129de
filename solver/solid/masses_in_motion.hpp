#pragma once

/// The soil that takes part in a motion.

#include <cmath>

#include "solid/solid_points.hpp"

namespace suffuse {

/// The part of the mass of each point, kg, that takes part in a motion by `way`, m: the share
/// d/d_m, at most 1, with d_m = sum(m d^2)/sum(m d), the mean way of what moves. All of it if
/// nothing moves.
inline std::vector<double> masses_in_motion(std::vector<double> mass,
                                            const std::vector<double>& way) {
  double moved = 0.0;
  double moved_twice = 0.0;
  for (std::size_t p = 0; p < mass.size(); ++p) {
    moved += mass[p] * way[p];
    moved_twice += mass[p] * way[p] * way[p];
  }
  if (!(moved_twice > 0.0)) return mass;
  const double mean = moved_twice / moved;
  for (std::size_t p = 0; p < mass.size(); ++p) mass[p] *= std::min(1.0, way[p] / mean);
  return mass;
}

/// Height of an upright block with the radius of gyration of `mass`, kg per point, m.
template <int Dim>
double height_of_block(const SolidPoints<Dim>& points, const Vector<Dim>& down,
                       const std::vector<double>& mass) {
  double sum = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (std::size_t p = 0; p < mass.size(); ++p) {
    const double depth = points.position[p].dot(down);
    sum += mass[p];
    first += mass[p] * depth;
    second += mass[p] * (depth * depth + std::pow(points.volume[p], 2.0 / Dim) / 12.0);
  }
  return sum > 0.0 ? std::sqrt(12.0 * std::abs(second - first * first / sum) / sum) : 0.0;
}

}  // namespace suffuse
