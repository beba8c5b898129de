#pragma once

/// Liquid material points of the double-point formulation: where they are and what they carry.

#include <vector>

#include "grid/point_place.hpp"
#include "mesh/material_points.hpp"

namespace suffuse {

/// Structure of arrays, sorted by element. A point is a mass of water and one of fines;
/// its volume follows.
template <int Dim>
struct LiquidPoints {
  std::vector<int> element;
  std::vector<std::array<double, Dim + 1>> barycentric;
  std::vector<double> water_mass;  ///< kg, constant
  std::vector<double> fines_mass;  ///< kg
  std::vector<long> id;            ///< constant number of the point
  /// Only if points carry the flow (material-point integration), otherwise empty.
  std::vector<double> pressure;       ///< Pa
  std::vector<Vector<Dim>> velocity;  ///< m/s

  [[nodiscard]] int size() const { return static_cast<int>(element.size()); }
  [[nodiscard]] PointPlace<Dim> place(int p) const { return {element[p], barycentric[p]}; }
  /// Reserves memory for points that carry the flow.
  void reserve(int count);
};

/// Sorts by element; points of one element keep their order.
template <int Dim>
void sort_by_element(LiquidPoints<Dim>& points, int element_count);

/// Points of element e: begin[e] .. begin[e + 1]. For sorted points.
template <int Dim>
std::vector<int> element_begins(const LiquidPoints<Dim>& points, int element_count);

/// Replaces the points by those with the numbers `order`, in that order.
template <int Dim>
void rearrange(LiquidPoints<Dim>& points, const std::vector<int>& order);

/// Keeps the points for which `keep` is not zero.
template <int Dim>
void keep_points(LiquidPoints<Dim>& points, const std::vector<unsigned char>& keep);

/// Densities from which a point's volume follows.
struct LiquidDensities {
  double water;  ///< at p = 0, kg/m3
  double grain;  ///< kg/m3
};

/// V_p = m_w / rho_w + m_f / rho_s, m3; `ratio` = rho_w / rho_w0.
inline double liquid_volume(double water_mass, double fines_mass, const LiquidDensities& densities,
                            double ratio) {
  return water_mass / (densities.water * ratio) + fines_mass / densities.grain;
}

/// Points at these places, sorted by element, of clean water with the density at the pressure of
/// their elements, Pa.
template <int Dim>
LiquidPoints<Dim> clean_liquid(const MaterialPoints<Dim>& places,
                               const std::vector<double>& pressure,
                               const LiquidDensities& densities, double bulk_modulus);

}  // namespace suffuse
