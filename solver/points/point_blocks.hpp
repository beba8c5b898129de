#pragma once

/// Liquid points that carry the flow, element by element: the points of an element lie in one piece
/// of memory, for the loops of an explicit flow step.

#include <array>
#include <vector>

#include "points/liquid_points.hpp"

namespace suffuse {

template <int Dim>
struct CarriedPoint {
  std::array<double, Dim> at;  ///< barycentric coordinates without the last; all add up to one
  Vector<Dim> velocity;        ///< m/s
  double pressure;             ///< Pa
  double water_mass;           ///< kg
  double fines_mass;           ///< kg
  long id;

  void archive(auto& archive) { archive(at, velocity, pressure, water_mass, fines_mass, id); }
};

/// All barycentric coordinates from those that are stored.
template <int Dim>
std::array<double, Dim + 1> all_coordinates(const std::array<double, Dim>& at) {
  std::array<double, Dim + 1> result;
  result[Dim] = 1.0;
  for (int a = 0; a < Dim; ++a) {
    result[a] = at[a];
    result[Dim] -= at[a];
  }
  return result;
}

/// Different threads may change, add and remove points of different elements.
template <int Dim>
class PointBlocks {
 public:
  /// Takes points that carry the flow, sorted by element, in their order.
  void fill(const LiquidPoints<Dim>& points, int element_count);
  /// All points, sorted by element.
  [[nodiscard]] LiquidPoints<Dim> points() const;

  [[nodiscard]] int size() const;
  [[nodiscard]] int element_count() const { return static_cast<int>(blocks_.size()); }
  [[nodiscard]] int count(int element) const { return static_cast<int>(blocks_[element].size()); }
  [[nodiscard]] std::vector<CarriedPoint<Dim>>& of(int element) { return blocks_[element]; }
  [[nodiscard]] const std::vector<CarriedPoint<Dim>>& of(int element) const {
    return blocks_[element];
  }
  /// Prefetches the points of an element, if it exists: a processor cannot predict the place of a
  /// block that was moved in memory.
  void prefetch(int element) const {
    if (element >= element_count()) return;
    for (const CarriedPoint<Dim>& point : blocks_[element]) __builtin_prefetch(&point, 1);
  }

  [[nodiscard]] double water_mass(int element, int slot) const {
    return blocks_[element][slot].water_mass;
  }
  [[nodiscard]] double fines_mass(int element, int slot) const {
    return blocks_[element][slot].fines_mass;
  }
  [[nodiscard]] std::array<double, Dim + 1> barycentric(int element, int slot) const {
    return all_coordinates<Dim>(blocks_[element][slot].at);
  }
  void add_fines(int element, int slot, double mass) { blocks_[element][slot].fines_mass += mass; }

  /// Removes a point; the element's last point takes its slot.
  CarriedPoint<Dim> remove(int element, int slot);
  /// Appends a point.
  void add(int element, const CarriedPoint<Dim>& point);

  void archive(auto& archive) { archive(blocks_); }

 private:
  std::vector<std::vector<CarriedPoint<Dim>>> blocks_;  ///< per element
};

}  // namespace suffuse
