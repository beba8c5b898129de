#pragma once

/// Fines that liquid points take up or deposit along their paths.

#include <array>

namespace suffuse {

/// The fines that a point takes up in one element that it passes, in the order of its path.
template <int Dim>
struct FinesUptake {
  int point;
  int element;
  std::array<double, Dim + 1> barycentric;  ///< half-way through the element
  /// Uptake that keeps (1 - c) n_L of the point constant, m3.
  double own_volume;
  int region;             ///< the region whose liquid receives it
  double exponent = 0.0;  ///< see FinesDeposition
  double mass = 0.0;      ///< uptake minus deposits, kg
};

}  // namespace suffuse
